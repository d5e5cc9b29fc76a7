// Cones of clusters that face many ways: they cull nothing, and all their numbers are numbers.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/facing_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sightline/base/random.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

bool isNumber(const FacingCone& cone) {
    double sum = cone.cutoff;
    for (int axis = 0; axis < 3; ++axis) sum += double(cone.apex[axis]) + double(cone.axis[axis]);
    return std::isfinite(sum);
}

TEST(FacingCone, OfNormalsThatNearlyAddUpToNothingCullsNothing) {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE(round);
        const glm::dvec3 ahead = glm::normalize(test::randomVector(random, 1.0) + glm::dvec3(0.01));
        const glm::dvec3 lean = std::pow(10, random.uniform(-9, -4)) * test::randomVector(random, 1.0);
        std::vector<Facet> facets;
        for (int i = 0; i < 64; ++i) {
            const glm::dvec3 p = test::randomVector(random, 1.0);
            facets.push_back({i % 2 ? ahead : glm::normalize(lean - ahead), {p, p, p}});
        }
        const FacingCone cone = makeFacingCone(facets);
        EXPECT_TRUE(isNumber(cone));
        EXPECT_GE(cone.cutoff, 1) << "half of them are seen from anywhere";
    }
}

}  // namespace
}  // namespace sightline
