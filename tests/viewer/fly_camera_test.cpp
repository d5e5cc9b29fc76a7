// The camera that a user moves: it begins where it is put, and goes where it is told.
// SPDX-License-Identifier: MIT
#include "apps/viewer/fly_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"

namespace sightline::viewer {
namespace {
using namespace test;
using namespace tools;

CameraFrame someFrame(Random& random) {
    CameraFrame frame;
    frame.eye = randomVector(random, 100.0);
    frame.target = frame.eye + randomVector(random, {1, 0.5, 1}) + glm::dvec3(0.01, 0, 0);
    frame.fov_y_degrees = random.uniform(20, 100);
    return frame;
}

TEST(FlyCamera, BeginsWithTheFrameThatItTakes) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        FlyCamera camera;
        const CameraFrame frame = someFrame(random);
        camera.take(frame);
        const View view = camera.view(160, 90), wanted = makeView(frame, 160, 90);
        EXPECT_EQ(view.view, wanted.view);
        EXPECT_EQ(view.projection, wanted.projection);
        // Once it has moved it is a camera of its own, which stands and looks as the frame does.
        camera.look(1e-12, 0);
        const View moved = camera.view(160, 90);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                EXPECT_NEAR(moved.view[column][row], wanted.view[column][row], 1e-8 * 200);
    }
}

TEST(FlyCamera, FliesWhereItLooksAndTurnsAroundAPoint) {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        FlyCamera camera;
        camera.take(someFrame(random));
        const glm::dvec3 from = camera.eye(), ahead = camera.forward();
        camera.fly({0, 0, 3});
        EXPECT_LT(glm::length(camera.eye() - from - 3.0 * ahead), 1e-9);
        camera.fly({2, 0, 0});
        EXPECT_NEAR(glm::dot(camera.eye() - from, ahead), 3, 1e-9) << "aside is across the direction";
        const glm::dvec3 around = randomVector(random, 100.0);
        const double distance = glm::length(around - camera.eye());
        camera.orbit(around, random.uniform(-2, 2), random.uniform(-1, 1));
        EXPECT_NEAR(glm::length(around - camera.eye()), distance, 1e-9 * distance);
        EXPECT_GT(glm::dot(glm::normalize(around - camera.eye()), camera.forward()), 1 - 1e-9);
        camera.look(0, 10);
        EXPECT_LT(camera.forward().y, 1) << "never straight up, where right is not known";
        EXPECT_TRUE(isUsable(camera.view(160, 90)));
    }
}

TEST(FlyCamera, FramesASphere) {
    FlyCamera camera;
    camera.fov_y_degrees = 50;
    camera.look(1, -0.4);
    camera.frame({5, 6, 7}, 2, 1);
    const View view = camera.view(100, 100);
    const glm::dmat4 to_clip = view.projection * view.view;
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec4 clip = to_clip * glm::dvec4(glm::dvec3(5, 6, 7) + 2.0 * randomUnit(random), 1.0);
        EXPECT_LE(std::abs(clip.x), clip.w * (1 + 1e-9));
        EXPECT_LE(std::abs(clip.y), clip.w * (1 + 1e-9));
    }
}

}  // namespace
}  // namespace sightline::viewer
