// A framing's cameras have all of its points in their images, and waste little of them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/framing.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sightline {
using namespace tools;
using namespace test;
namespace {

TEST(Framing, HasAllPointsInTheImage) {
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 center = randomVector(random, 50);
        Framing framing(center);
        std::vector<glm::dvec3> points;
        for (int i = 0; i < 20; ++i) {
            points.push_back(center + randomVector(random, {9, 2, 5}));
            framing.add(points.back());
        }
        const glm::dvec3 side = sideAt(random.uniform(-3, 3), random.uniform(-1.2, 1.2));
        const CameraFrame near = framing.nearest(side), around = Framing::at(center, side, framing.distanceFrom(side));
        for (const CameraFrame& camera : {near, around}) {
            const View view = makeView(camera, 300, 200);
            double most = 0;
            for (const glm::dvec3& point : points) {
                const glm::dvec4 p = view.projection * view.view * glm::dvec4(point, 1);
                ASSERT_GT(p.w, 0) << "round " << round;
                most = std::max({most, std::abs(p.x / p.w), std::abs(p.y / p.w)});
            }
            EXPECT_LE(most, 1) << "round " << round;
            EXPECT_GT(most, 0.9) << "round " << round;
        }
    }
}

}  // namespace
}  // namespace sightline
