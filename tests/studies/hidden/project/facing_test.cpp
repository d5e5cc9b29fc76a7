// Back-face tests: three places to make them, one answer, which is the exact one outside of a stated band.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/facing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/geom/view.h"
#include "sightline/studies/hidden/project/homogeneous.h"

namespace sightline {
using namespace studies;
namespace {

__extension__ typedef __int128 Wide;

/// Where a facing's size, relative to the cube of the farthest corner's distance, is below this, rounding may decide.
constexpr double kFacingBand = 0x1p-46;

int signOf(double value) { return (value > 0) - (value < 0); }

/// On the grid of 2^-44, so that differences are exact.
/// @param size  [limit: <= 32]
glm::dvec3 gridPoint(Random& random, double size) {
    const auto step = [&] { return std::rint(random.uniform(-size, size) * 0x1p44) * 0x1p-44; };
    const double x = step(), y = step(), z = step();
    return {x, y, z};
}

/// Triangles of all sorts: large ones, and some that are seen nearly edge-on or are nearly lines.
void randomTriangle(Random& random, const glm::dvec3& eye, int sort, glm::dvec3 (&v)[3]) {
    for (glm::dvec3& p : v) p = gridPoint(random, 8);
    const double grid = std::ldexp(1.0, 10 + int(random.below(35)));
    const auto snap = [grid](const glm::dvec3& p) { return glm::round(p * grid) / grid; };
    if (sort == 1) v[2] = snap(eye + 0.7 * (v[0] - eye) + 0.9 * (v[1] - eye));
    if (sort == 2) v[2] = snap(0.3 * v[0] + 0.7 * v[1]);
}

TEST(TripleProduct, IsExactWhereDoublesRound) {
    Random random(31);
    int zero = 0;
    for (int i = 0; i < 100000; ++i) {
        // Small integers times powers of two: exact in 128 bits, and often zero.
        Wide n[3][3];
        glm::dvec3 d[3];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) {
                const int64_t value = static_cast<int64_t>(random.below(1u << 31)) - (1 << 30);
                n[row][column] = row == 2 && i % 2 ? n[0][column] + 3 * n[1][column] : value;
                if (row == 2 && i % 6 == 1 && column == 1) n[row][column] += 1;
                d[row][column] = static_cast<double>(n[row][column]);
            }
        const Wide product = n[0][0] * (n[1][1] * n[2][2] - n[1][2] * n[2][1]) -
                             n[0][1] * (n[1][0] * n[2][2] - n[1][2] * n[2][0]) +
                             n[0][2] * (n[1][0] * n[2][1] - n[1][1] * n[2][0]);
        const int expected = (product > 0) - (product < 0);
        zero += expected == 0;
        ASSERT_EQ(tripleProductSign(d[0], d[1], d[2]), expected) << "case " << i;
        ASSERT_EQ(tripleProductSign(d[1], d[0], d[2]), -expected) << "case " << i;
        ASSERT_EQ(tripleProductSign(d[1] * 0x1p-200, d[2], d[0] * 0x1p100), expected) << "case " << i;
    }
    EXPECT_GT(zero, 10000);
}

TEST(Facing, IsTheLecturesExample) {
    const glm::dvec3 view(-1, 0, -1), front(2, 1, 2), back(-3, 1, -2);
    EXPECT_EQ(glm::dot(view, front), -4.0);
    EXPECT_EQ(parallelFacing(front, view), 4.0);  // positive: front
    EXPECT_EQ(glm::dot(view, back), 5.0);
    EXPECT_EQ(parallelFacing(back, view), -5.0);
}

TEST(Facing, NormalLooksAtWhomTheTriangleIsCounterClockwiseFor) {
    // Counter-clockwise as seen from +z. The lecture's (v0 - v1) x (v2 - v1) gives the opposite: E4.
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    EXPECT_EQ(faceNormal(a, b, c), glm::dvec3(0, 0, 1));
    EXPECT_EQ(glm::cross(a - b, c - b), glm::dvec3(0, 0, -1));
    EXPECT_GT(eyeFacing(a, b, c, {0.2, 0.2, 5}), 0);
    EXPECT_LT(eyeFacing(a, b, c, {0.2, 0.2, -5}), 0);
    EXPECT_EQ(eyeFacing(a, b, c, {7, 8, 0}), 0);
    EXPECT_GT(screenFacing(glm::dvec2(a), glm::dvec2(b), glm::dvec2(c)), 0);
}

/// The signs of the tests for one triangle, beside the exact one.
struct Signs {
    int exact = 0, eye = 0, object = 0, homogeneous = 0, screen = 0;
    bool has_screen = false, in_band = false;
};

Signs perspectiveSigns(const glm::dvec3 (&v)[3], const glm::dvec3& eye, const View& view) {
    Signs signs;
    // Seen from the eye, a counter-clockwise triangle's corners turn the other way round than its normal points.
    const glm::dvec3 a = v[0] - eye, b = v[1] - eye, c = v[2] - eye;
    const double size = std::pow(std::max({glm::length(a), glm::length(b), glm::length(c)}), 3);
    signs.exact = -tripleProductSign(a, b, c);
    signs.in_band = std::abs(glm::dot(glm::cross(a, b), c)) <= kFacingBand * size;
    signs.eye = signOf(eyeFacing(v[0], v[1], v[2], eye));
    const glm::dmat4 to_clip = view.projection * view.view;
    glm::dvec4 clip[3];
    signs.has_screen = true;
    for (int k = 0; k < 3; ++k) {
        clip[k] = to_clip * glm::dvec4(v[k], 1);
        signs.has_screen &= clip[k].w > 0.1;
    }
    glm::dvec3 normal;
    signs.homogeneous = signOf(homogeneousFacing(clip[0], clip[1], clip[2], normal));
    const auto on_screen = [&](int k) { return glm::dvec2(clip[k]) / clip[k].w; };
    if (signs.has_screen) signs.screen = signOf(screenFacing(on_screen(0), on_screen(1), on_screen(2)));
    return signs;
}

TEST(Facing, ThreeTestsAgreeWithTheExactSignInPerspective) {
    Random random(32);
    uint64_t in_band = 0, on_screen = 0, behind = 0, wrong = 0, zero = 0, sided[3] = {};
    for (int i = 0; i < 1000000; ++i) {
        const glm::dvec3 eye = gridPoint(random, 4);
        glm::dvec3 v[3];
        randomTriangle(random, eye, i % 4, v);
        View view;
        view.view = lookAt(eye, gridPoint(random, 9), {0, 1, 0});
        view.projection = perspective(random.uniform(0.3, 2), random.uniform(0.5, 2), 0.1);
        const Signs signs = perspectiveSigns(v, eye, view);
        zero += signs.exact == 0;
        ++sided[signs.exact + 1];
        on_screen += signs.has_screen;
        behind += !signs.has_screen;
        in_band += signs.in_band;
        wrong += signs.in_band && (signs.eye != signs.exact || signs.homogeneous != signs.exact ||
                                   (signs.has_screen && signs.screen != signs.exact));
        if (signs.in_band) continue;
        ASSERT_EQ(signs.eye, signs.exact) << "case " << i;
        ASSERT_EQ(signs.homogeneous, signs.exact) << "case " << i;
        if (signs.has_screen) { ASSERT_EQ(signs.screen, signs.exact) << "case " << i; }
    }
    std::printf(
        "1000000 triangles: %zu front, %zu back, %zu edge-on, %zu in the band (%zu of them differ), "
        "%zu in front of the eye\n",
        size_t(sided[2]), size_t(sided[0]), size_t(zero), size_t(in_band), size_t(wrong), size_t(on_screen));
    // A quarter are made to be nearly edge-on, and a quarter to be nearly lines, by as little as 2^-44.
    EXPECT_LT(in_band, 100000u);
    EXPECT_GT(wrong, 0u);
    EXPECT_GT(on_screen, 50000u);
    EXPECT_GT(behind, 50000u);
}

TEST(Facing, ThreeTestsAgreeWithTheExactSignInParallelViews) {
    Random random(33);
    uint64_t in_band = 0;
    for (int i = 0; i < 300000; ++i) {
        const glm::dvec3 from = gridPoint(random, 4), to = gridPoint(random, 4), forward = to - from;
        if (glm::length(forward) < 0.1) continue;
        glm::dvec3 v[3];
        randomTriangle(random, from, i % 4 == 1 ? 0 : i % 4, v);
        const glm::dvec3 ab = v[1] - v[0], ac = v[2] - v[0];
        const int exact = -tripleProductSign(ab, ac, forward);
        const double size = glm::length(ab) * glm::length(ac) * glm::length(forward);
        // The corners' places round, too, by how far they are from the origin.
        const double places = 64 * (glm::length(ab) + glm::length(ac)) * glm::length(forward);
        if (std::abs(glm::dot(glm::cross(ab, ac), forward)) <= kFacingBand * (size + places)) {
            ++in_band;
            continue;
        }
        ASSERT_EQ(signOf(parallelFacing(faceNormal(v[0], v[1], v[2]), forward)), exact) << "case " << i;
        const glm::dmat4 to_clip = orthographic(8, 1.5, 0.1, 50) * lookAt(from, to, {0, 1, 0});
        glm::dvec4 clip[3];
        for (int k = 0; k < 3; ++k) clip[k] = to_clip * glm::dvec4(v[k], 1);
        glm::dvec3 normal;
        ASSERT_EQ(signOf(homogeneousFacing(clip[0], clip[1], clip[2], normal)), exact) << "case " << i;
        ASSERT_EQ(signOf(screenFacing(glm::dvec2(clip[0]), glm::dvec2(clip[1]), glm::dvec2(clip[2]))), exact)
            << "case " << i;
    }
    EXPECT_LT(in_band, 30000u);
}

TEST(Facing, TheScreensAreaMeansNothingBehindTheEye) {
    // A floor, seen from above: its front, whatever part of it lies behind the eye.
    const auto project = [](const glm::dvec3& p) { return glm::dvec4(p.x, p.y, -p.z - 0.2, -p.z); };
    for (const double behind : {-3.0, 2.0, 5.0}) {
        const glm::dvec4 a = project({-1, -1, -5}), b = project({0, -1, behind}), c = project({1, -1, -5});
        glm::dvec3 normal;
        const double volume = homogeneousFacing(a, b, c, normal);
        EXPECT_GT(volume, 0) << behind;
        const double area = screenFacing(glm::dvec2(a) / a.w, glm::dvec2(b) / b.w, glm::dvec2(c) / c.w);
        EXPECT_EQ(signOf(area), behind < 0 ? 1 : -1) << behind;
    }
}

TEST(Facing, ObjectSpaceNeedsNoTurningAboutForMirrors) {
    Random random(34);
    for (int i = 0; i < 100000; ++i) {
        glm::dvec3 v[3];
        const glm::dvec3 eye = gridPoint(random, 9), forward = gridPoint(random, 2);
        randomTriangle(random, eye, 0, v);
        glm::dmat4 transform(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) transform[column][row] = random.uniform(-2, 2);
        const double determinant = glm::determinant(glm::dmat3(transform));
        if (std::abs(determinant) < 1e-3) continue;
        glm::dvec3 world[3];
        for (int k = 0; k < 3; ++k) world[k] = transform * glm::dvec4(v[k], 1);
        const int mirror = determinant < 0 ? -1 : 1;
        const double there = eyeFacing(world[0], world[1], world[2], eye);
        const double here = eyeFacing(v[0], v[1], v[2], eyeInObject(transform, eye));
        const double along = parallelFacing(faceNormal(world[0], world[1], world[2]), forward);
        const double along_here = parallelFacing(faceNormal(v[0], v[1], v[2]), directionInObject(transform, forward));
        const bool clear = std::abs(there) > 1e-7, clear_along = std::abs(along) > 1e-7;
        ASSERT_TRUE(!clear || signOf(here) == mirror * signOf(there)) << "case " << i;
        ASSERT_TRUE(!clear_along || signOf(along_here) == mirror * signOf(along)) << "case " << i;
    }
}

}  // namespace
}  // namespace sightline
