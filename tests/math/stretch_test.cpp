// The bound on how much a transform stretches: held to random directions.
// SPDX-License-Identifier: MIT
#include "sightline/math/stretch.h"

#include <gtest/gtest.h>

#include <limits>

#include "sightline/base/random.h"

namespace sightline {
namespace {

TEST(Stretch, NoDirectionIsStretchedMore) {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        glm::dmat4 transform(1.0);
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) transform[column][row] = random.uniform(-3, 3);
        const double stretch = largestStretch(transform);
        for (int i = 0; i < 30; ++i) {
            const glm::dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            ASSERT_LE(glm::length(glm::dmat3(transform) * v), stretch * glm::length(v) * (1 + 1e-12));
        }
    }
    glm::dmat4 scaled(1.0);
    scaled[0] *= 2.0;
    scaled[1] *= -3.0;
    EXPECT_NEAR(largestStretch(scaled), 3.0, 1e-11);
    EXPECT_EQ(largestStretch(glm::dmat4(0.0)), 0.0);
    scaled[2][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(largestStretch(scaled), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace sightline
