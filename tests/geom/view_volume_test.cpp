// The law of view volumes: a point is inside all planes exactly if clip space says so, for every kind of matrix.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/base/random.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

/// Turns a depth of -w to w into one of 0 to w, and that round on request.
glm::dmat4 withDepth(glm::dmat4 projection, const ClipSpace& space) {
    for (int column = 0; column < 4; ++column) {
        double& z = projection[column][2];
        const double w = projection[column][3];
        if (space.reversed) z = -z;
        if (space.depth == ClipDepth::kZeroToOne) z = 0.5 * (z + w);
    }
    return projection;
}

glm::dmat4 randomProjection(Random& random) {
    const double aspect = random.uniform(0.3, 3.0), angle = random.uniform(0.1, 2.6);
    glm::dmat4 p = perspective(angle, aspect, random.uniform(0.01, 1.0), random.uniform(5.0, 100.0));
    switch (random.below(5)) {
        case 0:
            return perspective(angle, aspect, 0.1);
        case 1:
            return orthographic(random.uniform(1, 30), aspect, random.uniform(-3, 1), 40.0);
        case 2:
            p[2][0] = random.uniform(-2, 2), p[2][1] = random.uniform(-2, 2);
            return p;
        case 3: {  // an oblique near plane: depth is made of the plane through the near plane's place
            const glm::dvec3 n = glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), -2.0));
            const glm::dvec4 oblique(n, random.uniform(-4.0, -1.0));
            for (int column = 0; column < 4; ++column) p[column][2] = oblique[column] - p[column][3];
            return p;
        }
        default:
            return p;
    }
}

bool insideClip(const glm::dvec4& c, ClipDepth depth) {
    const double low = depth == ClipDepth::kZeroToOne ? 0.0 : -c.w;
    return -c.w <= c.x && c.x <= c.w && -c.w <= c.y && c.y <= c.w && low <= c.z && c.z <= c.w;
}

double worstPlane(const ViewVolume& volume, const glm::dvec3& p) {
    double worst = volume.empty ? -INFINITY : INFINITY;
    for (uint32_t i = 0; i < volume.count; ++i)
        worst = std::min(worst, glm::dot(glm::dvec3(volume.planes[i]), p - volume.eye) + volume.planes[i].w);
    return worst;
}

TEST(ViewVolume, HoldsAPointExactlyIfClipSpaceDoes) {
    Random random(11);
    size_t inside = 0;
    for (int round = 0; round < 4000; ++round) {
        const ClipSpace space{random.below(2) ? ClipDepth::kZeroToOne : ClipDepth::kMinusOneToOne,
                              random.below(2) == 0};
        const glm::dvec3 eye = 1e5 * test::randomUnit(random);
        const glm::dmat4 rotation = glm::dmat4(glm::dmat3(lookAt({0, 0, 0}, test::randomUnit(random), {0, 1, 0})));
        const glm::dmat4 clip = withDepth(randomProjection(random), space) * rotation;
        const ViewVolume volume = volumeOfMatrix(clip, eye, space);
        ASSERT_GE(volume.count, 5u);
        ASSERT_FALSE(provedEmpty(volume));
        const glm::dmat4 inverse = glm::inverse(clip);
        for (int i = 0; i < 50; ++i) {
            const glm::dvec4 unprojected = inverse * glm::dvec4(random.uniform(-1.3, 1.3), random.uniform(-1.3, 1.3),
                                                                random.uniform(-1.3, 0.99), 1.0);
            const glm::dvec3 p = glm::dvec3(unprojected) / unprojected.w;
            const double worst = worstPlane(volume, eye + p);
            if (std::abs(worst) < 1e-9 * (1e5 + glm::length(p))) continue;  // too near to a plane to tell
            const bool is_inside = insideClip(clip * glm::dvec4(p, 1.0), space.depth);
            ASSERT_EQ(worst > 0.0, is_inside) << "round " << round << " point " << i;
            inside += is_inside;
        }
    }
    EXPECT_GT(inside, 20000u);
}

TEST(ViewVolume, LeavesOutAFarPlaneAtInfinityInEveryConvention) {
    for (const ClipDepth depth : {ClipDepth::kMinusOneToOne, ClipDepth::kZeroToOne})
        for (const bool reversed : {false, true}) {
            const ClipSpace space{depth, reversed};
            const Frustum frustum = frustumOfMatrix(withDepth(perspective(1.0, 1.5, 0.1), space), {0, 0, 0}, space);
            ASSERT_EQ(frustum.count, 5u);
            for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(frustum.side[i], i);  // the near plane is called so
            EXPECT_NEAR(frustum.planes[4].z, -1.0, 1e-12);
            EXPECT_NEAR(frustum.planes[4].w, -0.1, 1e-12);
        }
}

TEST(ViewVolume, IsTheFrustumOfAViewWithoutJitter) {
    View view;
    view.jitter = 0.0;
    view.view = lookAt({3, 4, 5}, {0, 1, 0}, {0, 1, 0});
    view.projection = perspective(1.0, 1.5, 0.1, 100.0);
    const Frustum expected = makeFrustum(view);
    const Frustum frustum = frustumOfMatrix(view.projection * glm::dmat4(glm::dmat3(view.view)), eyePosition(view));
    ASSERT_EQ(frustum.count, expected.count);
    for (uint32_t i = 0; i < frustum.count; ++i)
        EXPECT_LT(glm::length(frustum.planes[i] - expected.planes[i]), 1e-12) << i;
}

TEST(ViewVolume, AMatrixThatIsNotFiniteMakesNoPlaneOfNaN) {
    glm::dmat4 clip = perspective(1.0, 1.0, 0.1);
    clip[1][0] = std::numeric_limits<double>::quiet_NaN();
    clip[2][2] = std::numeric_limits<double>::infinity();
    const ViewVolume volume = volumeOfMatrix(clip, {0, 0, 0});
    EXPECT_LE(volume.count, 2u);
    for (uint32_t i = 0; i < volume.count; ++i)
        EXPECT_TRUE(std::isfinite(glm::dot(volume.planes[i], volume.planes[i])));
}

TEST(ViewVolume, APlaneThroughThreePointsFacesThoseWhoSeeThemTurnLeft) {
    const glm::dvec4 plane = planeOfPoints({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
    EXPECT_EQ(plane, glm::dvec4(0, 0, 1, -2));
    EXPECT_EQ(planeOfPoints({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), glm::dvec4(0.0));
}

TEST(ViewVolume, AWindowIsSeenThroughExactlyAsTheRayFromTheEyeMeetsIt) {
    Random random(12);
    size_t inside = 0;
    for (int round = 0; round < 2000; ++round) {
        // A convex window: corners on an ellipse, in either order of turn.
        const glm::dvec3 center = 10.0 * test::randomUnit(random), u = test::randomUnit(random);
        const glm::dvec3 v = glm::normalize(glm::cross(u, test::randomUnit(random))), n = glm::cross(u, v);
        const size_t count = 3 + random.below(6);
        const double turn = random.below(2) ? 1.0 : -1.0;
        std::vector<glm::dvec3> window;
        for (size_t i = 0; i < count; ++i) {
            const double angle =
                turn * (static_cast<double>(i) + 0.4 * random.uniform()) * 6.283 / static_cast<double>(count);
            window.push_back(center + 2.0 * std::cos(angle) * u + std::sin(angle) * v);
        }
        const glm::dvec3 eye = center + 3.0 * test::randomUnit(random);
        const double height = glm::dot(n, eye - center);
        if (std::abs(height) < 0.05) continue;
        const bool behind = random.below(2) == 0;
        const ViewVolume volume = volumeOfWindow(eye, window, behind);
        ASSERT_EQ(volume.count, count + behind);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 p = center + 3.0 * test::randomUnit(random) + random.uniform(-3, 3) * n;
            const double along = glm::dot(n, p - center);
            const double t = height / (height - along);  // where the line from the eye to the point meets the plane
            bool expected = t > 0.0 && (!behind || t <= 1.0);
            const glm::dvec3 hit = eye + t * (p - eye);
            double edge = INFINITY;
            for (size_t k = 0; k < count; ++k) {
                const glm::dvec3 side = window[(k + 1) % count] - window[k];
                edge = std::min(edge, turn * glm::dot(glm::cross(side, hit - window[k]), n) / glm::length(side));
            }
            if (std::abs(edge) < 1e-6 || std::abs(t - 1.0) < 1e-6 || std::abs(t) > 1e6) continue;
            expected &= edge > 0.0;
            ASSERT_EQ(worstPlane(volume, p) > 0.0, expected) << "round " << round;
            inside += expected;
        }
    }
    EXPECT_GT(inside, 1000u);
}

TEST(ViewVolume, AnEyeInTheWindowsPlaneSeesEverything) {
    const glm::dvec3 window[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(volumeOfWindow({5, 0.5, 0}, window, true).count, 0u);
    EXPECT_EQ(volumeOfWindow({0.5, 0.5, 1}, std::span(window).first(2), true).count, 0u);
    EXPECT_EQ(volumeOfWindow({0.5, 0.5, 1}, window, true).count, 5u);
}

TEST(ViewVolume, IntersectionsHoldWhatAllHold) {
    Random random(13);
    for (int round = 0; round < 1000; ++round) {
        View view;
        view.view = lookAt(4.0 * test::randomUnit(random), {0, 0, 0}, {0, 1, 0});
        view.projection = perspective(1.0, 1.3, 0.1, 20.0);
        ViewVolume volume = volumeOf(makeFrustum(view));
        const ViewVolume frustum = volume;
        view.view = lookAt(4.0 * test::randomUnit(random), {0, 0, 0}, {0, 1, 0});
        const ViewVolume other = volumeOf(makeFrustum(view));
        const glm::dvec4 section =
            planeOfPoints(test::randomUnit(random), test::randomUnit(random), test::randomUnit(random));
        ASSERT_TRUE(intersect(volume, other));
        ASSERT_TRUE(addPlane(volume, 3.0 * section));
        ASSERT_TRUE(intersect(volume, other));  // again: nothing new
        ASSERT_LE(volume.count, 13u);
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 p = random.uniform(0, 4) * test::randomUnit(random);
            const double expected =
                std::min({worstPlane(frustum, p), worstPlane(other, p), glm::dot(glm::dvec3(section), p) + section.w});
            ASSERT_NEAR(worstPlane(volume, p), expected, 1e-9);
        }
    }
}

TEST(ViewVolume, TellsThatNothingIsLeft) {
    View view;
    view.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
    view.projection = perspective(1.0, 1.0, 0.1, 10.0);
    ViewVolume volume = volumeOf(makeFrustum(view));
    EXPECT_FALSE(provedEmpty(volume));
    ViewVolume cut = volume;
    EXPECT_TRUE(addPlane(cut, {0, 0, 1, 5}));  // before z = -5
    EXPECT_FALSE(provedEmpty(cut));
    EXPECT_TRUE(addPlane(cut, {0, 0, -1, -6}));  // behind z = -6
    EXPECT_TRUE(provedEmpty(cut));
    EXPECT_TRUE(addPlane(volume, {0, 0, 0, -1}));
    EXPECT_TRUE(volume.empty);
    ViewVolume full;
    for (int i = 0; i < 40; ++i) EXPECT_EQ(addPlane(full, {std::cos(0.1 * i), std::sin(0.1 * i), 0, 1}), i < 31) << i;
}

TEST(ViewVolume, APlaneOfSupportTouchesTheVolume) {
    Random random(14);
    int checked = 0;
    for (int round = 0; round < 500; ++round) {
        const glm::dmat4 clip = randomProjection(random);
        const ViewVolume volume = volumeOfMatrix(clip, {0, 0, 0});
        const glm::dvec3 normal = test::randomUnit(random);
        glm::dvec4 plane;
        const bool bounded = supportPlane(volume, normal, plane);
        const glm::dmat4 inverse = glm::inverse(clip);
        double least = INFINITY, size = 0.0;
        bool ends = true;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 p =
                inverse * glm::dvec4(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1, 1.0);
            ends &= p.w > 1e-12;  // not at infinity, nor beyond, where an oblique far plane is
            if (std::abs(p.w) < 1e-12) continue;
            const glm::dvec3 at = glm::dvec3(p) / p.w;
            least = std::min(least, glm::dot(normal, at) + plane.w);
            size = std::max(size, glm::length(at));
        }
        if (!ends) continue;
        ASSERT_TRUE(bounded) << round;
        EXPECT_LT(glm::length(glm::dvec3(plane) - normal), 1e-11);
        EXPECT_NEAR(least, 0.0, 1e-9 * size) << round;
        ++checked;
    }
    EXPECT_GT(checked, 150);
}

TEST(ViewVolume, BothEyesSeeWhatTheirCommonVolumeHolds) {
    Random random(15);
    for (int round = 0; round < 300; ++round) {
        View left;
        left.jitter = 0.0;
        left.view = lookAt(5.0 * test::randomUnit(random), {0, 0, 0}, {0, 1, 0});
        const bool infinite = round % 2 == 0, canted = round % 4 >= 2;
        left.projection = perspective(1.2, 1.1, 0.05, infinite ? INFINITY : 50.0);
        if (canted) left.projection[2][0] = 0.2;
        View right = shiftedEye(left, 0.064);
        if (canted) {
            right.projection[2][0] = -0.2;
            const double turn = random.uniform(0.02, 0.3);
            const glm::dmat4 cant{{std::cos(turn), 0, std::sin(turn), 0},
                                  {0, 1, 0, 0},
                                  {-std::sin(turn), 0, std::cos(turn), 0},
                                  {0, 0, 0, 1}};
            right.view = cant * right.view;
        }
        const ViewVolume eyes[2] = {volumeOf(makeFrustum(left)), volumeOf(makeFrustum(right))};
        const ViewVolume both = volumeOfBoth(eyes[0], eyes[1]);
        if (!canted) { EXPECT_EQ(both.count, infinite ? 5u : 6u); }
        ASSERT_GE(both.count, infinite ? 5u : 6u) << round;
        for (const View& view : {left, right}) {
            const glm::dmat4 inverse = glm::inverse(view.projection * view.view);
            for (int i = 0; i < 50; ++i) {
                const glm::dvec4 p =
                    inverse * glm::dvec4(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0.9999), 1.0);
                ASSERT_GE(worstPlane(both, glm::dvec3(p) / p.w), -1e-9 * (1.0 + glm::length(glm::dvec3(p) / p.w)))
                    << round;
            }
        }
        // And not much more: what is straight behind both is not in it.
        const glm::dvec3 back = glm::dvec3(glm::inverse(left.view)[2]);
        EXPECT_LT(worstPlane(both, eyePosition(left) + 1.0 * back), 0.0) << round;
    }
}

}  // namespace
}  // namespace sightline
