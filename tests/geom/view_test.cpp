// The laws of views: matrices put points where their definition says, and the eye is found again.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sightline/base/random.h"
#include "sightline/geom/frustum.h"

namespace sightline {
namespace {

TEST(View, PerspectivePutsTheNearAndFarPlanesAtTheEndsOfDepth) {
    for (const double z_far : {50.0, std::numeric_limits<double>::infinity()}) {
        const glm::dmat4 p = perspective(glm::radians(60.0), 2.0, 0.5, z_far);
        const glm::dvec4 near = p * glm::dvec4(0, 0, -0.5, 1);
        EXPECT_NEAR(near.z / near.w, -1.0, 1e-12);
        const glm::dvec4 top = p * glm::dvec4(0, 3.0 * std::tan(glm::radians(30.0)), -3.0, 1);
        EXPECT_NEAR(top.y / top.w, 1.0, 1e-12);
        const glm::dvec4 far = p * glm::dvec4(0, 0, std::isinf(z_far) ? -1e12 : -50.0, 1);
        EXPECT_NEAR(far.z / far.w, 1.0, 1e-9);
    }
}

TEST(View, OrthographicSpansItsHeightAndKeepsItsNearPlane) {
    for (const double z_far : {50.0, std::numeric_limits<double>::infinity()}) {
        const glm::dmat4 p = orthographic(10.0, 2.0, 0.5, z_far);
        EXPECT_NEAR((p * glm::dvec4(10, 5, -3, 1)).x, 1.0, 1e-12);
        EXPECT_NEAR((p * glm::dvec4(10, 5, -3, 1)).y, 1.0, 1e-12);
        EXPECT_LT((p * glm::dvec4(0, 0, -0.499, 1)).z, -1.0);
        EXPECT_GT((p * glm::dvec4(0, 0, -0.501, 1)).z, -1.0);
        EXPECT_LE((p * glm::dvec4(0, 0, std::isinf(z_far) ? -2e9 : -50.0, 1)).z, 1.0 + 1e-9);
    }
}

TEST(View, FindsItsEyeAgainEvenFromARoundedMatrix) {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 eye(random.uniform(-1e6, 1e6), random.uniform(-1e6, 1e6), random.uniform(-1e6, 1e6));
        View view;
        view.view = lookAt(eye, eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), 1), {0, 1, 0});
        EXPECT_LT(glm::length(eyePosition(view) - eye), 1e-8);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) view.view[column][row] = static_cast<float>(view.view[column][row]);
        // Wherever that matrix has its eye: the point that it maps to the origin.
        EXPECT_LT(glm::length(glm::dvec3(view.view * glm::dvec4(eyePosition(view), 1.0))), 1e-8);
    }
}

TEST(View, LooksStraightUpWithoutLosingItsAxes) {
    const glm::dmat4 m = lookAt({0, 0, 0}, {0, 1, 0}, {0, 1, 0});
    EXPECT_NEAR(glm::determinant(glm::dmat3(m)), 1.0, 1e-12);
    EXPECT_NEAR((m * glm::dvec4(0, 1, 0, 1)).z, -1.0, 1e-12);
}

TEST(View, SaysWhenItCannotBeUsed) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.1);
    EXPECT_TRUE(isUsable(view));
    EXPECT_FALSE(isOrthographic(view));
    view.height = 0;
    EXPECT_FALSE(isUsable(view));
    view.height = 1;
    view.projection[2][2] = std::nan("");
    EXPECT_FALSE(isUsable(view));
    view.projection = glm::dmat4(0.0);
    EXPECT_FALSE(isUsable(view));
}

TEST(View, RunsOutwardUnlessItsDepthIsReversed) {
    // What the far plane cut away would hide: 27 false culls in one frame.
    const double infinite = std::numeric_limits<double>::infinity();
    for (double far : {40.0, infinite})
        for (glm::dmat4 projection : {perspective(1.0, 2.0, 0.5, far), orthographic(3.0, 2.0, 0.5, far)}) {
            View view;
            view.width = view.height = 8;
            view.projection = projection;
            EXPECT_TRUE(runsOutward(view)) << far;
            for (int column = 0; column < 4; ++column) view.projection[column][2] *= -1.0;
            EXPECT_FALSE(runsOutward(view)) << far;
        }
}

TEST(FrustumPlanes, AreTheInequalitiesOfClipSpace) {
    Random random(2);
    View view;
    view.width = 200;
    view.height = 100;
    view.jitter = 0;
    const glm::dvec3 eye(3, 4, 5);
    view.view = lookAt(eye, eye + glm::dvec3(1, 0.2, -0.4), {0, 1, 0});
    view.projection = perspective(1.0, 2.0, 0.5, 40.0);
    const Frustum frustum = makeFrustum(view);
    ASSERT_EQ(frustum.count, 6u);
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 p =
            eye + glm::dvec3(random.uniform(-45, 45), random.uniform(-45, 45), random.uniform(-45, 45));
        const glm::dvec4 clip = view.projection * view.view * glm::dvec4(p, 1.0);
        const double sides[6] = {clip.w + clip.x, clip.w - clip.x, clip.w + clip.y,
                                 clip.w - clip.y, clip.w + clip.z, clip.w - clip.z};
        for (int plane = 0; plane < 6; ++plane) {
            const double distance = glm::dot(glm::dvec3(frustum.planes[plane]), p - eye) + frustum.planes[plane].w;
            if (std::abs(distance) > 1e-9) { ASSERT_EQ(distance > 0, sides[plane] > 0) << "plane " << plane; }
        }
    }
    view.projection = perspective(1.0, 2.0, 0.5);
    EXPECT_EQ(makeFrustum(view).count, 5u);
}

}  // namespace
}  // namespace sightline
