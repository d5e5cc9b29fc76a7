// The law of normal masks: no class is culled of which a triangle in the window faces the eye; and how many are found.
// SPDX-License-Identifier: MIT
#include "sightline/studies/facing/normal_masks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sightline/prepare/facing/normal_classes.h"
#include "tests/cull/facing_oracle.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline {
using namespace studies;
namespace {

View randomView(Random& random, const glm::dvec3& middle) {
    View view = test::anyView(random, middle);
    view.jitter = random.below(2) ? 0.0 : random.uniform(0, 20);
    return view;
}

/// Turned, scaled unequally, mirrored every other time.
glm::dmat4 randomTransform(Random& random) {
    glm::dmat4 m(1.0);
    do {
        for (int column = 0; column < 3; ++column)
            m[column] = glm::dvec4(random.uniform(0.2, 3.0) * test::randomUnit(random), 0.0);
    } while (std::abs(glm::determinant(glm::dmat3(m))) < 0.01);
    m[3] = glm::dvec4(test::randomVector(random, random.below(4) ? 10.0 : 1e5), 1.0);
    return m;
}

/// A point of the window at some depth, in the object's space.
glm::dvec3 pointInView(Random& random, const View& view, const glm::dmat4& transform, const glm::dvec4& window) {
    const double x = random.uniform(window[0], window[2]), y = random.uniform(window[1], window[3]);
    const glm::dvec4 p = glm::inverse(view.projection) * glm::dvec4(x, y, random.uniform(-1.0, 0.99), 1.0);
    const glm::dvec3 world = glm::inverse(glm::dmat3(view.view)) * (glm::dvec3(p) / p.w) + eyePosition(view);
    return glm::inverse(glm::dmat3(transform)) * (world - glm::dvec3(transform[3]));
}

/// A triangle through a point, some of them seen nearly edge-on. One that no longer holds its point is of no use here:
/// the point is a corner.
void addThrough(Random& random, const glm::dvec3& p, const FacingEye& eye, test::TestMesh& mesh) {
    const double size = std::ldexp(1.0, -static_cast<int>(random.below(10)));
    const glm::dvec3 b = p + test::randomVector(random, size);
    glm::dvec3 c = p + test::randomVector(random, size);
    if (random.below(3) == 0) {
        const glm::dvec3 ahead = glm::normalize(eye.w == 0.0 ? eye.point : eye.point - p);
        c = p + random.uniform(0.1, 1.0) * size * (ahead + test::randomVector(random, 1e-4));
    }
    mesh.add(glm::vec3(p), glm::vec3(b), glm::vec3(c));
}

/// How far a triangle's facing may be off because the eye is: the tests judge by the eye as it was computed.
struct QuadBound {
    double value;

    QuadBound(const test::TestMesh& mesh, size_t i, const FacingEye& eye) {
        const glm::dvec3 a(mesh.positions[3 * i]), b(mesh.positions[3 * i + 1]), c(mesh.positions[3 * i + 2]);
        value = 2.0 * glm::length(glm::cross(b - a, c - a)) * eye.error;
    }
};

TEST(NormalMasks, NoFrontFaceInTheWindowIsCulled) {
    Random random(91);
    const size_t per_view = 2000, views = test::casesToMake(1000000) / per_view;
    size_t fronts = 0, culled = 0;
    for (size_t v = 0; v < views && !HasFailure(); ++v) {
        const glm::dmat4 m = randomTransform(random);
        const View view = randomView(random, glm::dvec3(m[3]));
        const FrontFace front = v % 3 ? FrontFace::kCounterClockwise : FrontFace::kClockwise;
        const FacingEye eye = facingEye(view, m, front);
        const CornerRays rays = cornerRays(view, m);
        ASSERT_TRUE(eye.known() && rays.known());
        const int cells = 1 + static_cast<int>(random.below(NormalClasses::kMaxCells));
        const glm::dvec2 wider = 1.0 + 2.0 * view.jitter / glm::dvec2(view.width, view.height);
        test::TestMesh mesh;
        for (size_t i = 0; i < per_view; ++i) {
            // Inside by more than the corner's rounding to float moves it.
            const double inside = 1.0 - 1e-4;
            const glm::dvec3 p =
                pointInView(random, view, m, inside * glm::dvec4(-wider.x, -wider.y, wider.x, wider.y));
            addThrough(random, p, eye, mesh);
        }
        const NormalClasses classes = makeNormalClasses(mesh.view(), cells);
        const NormalMask mask = makeNormalMask(rays, front, cells);
        std::vector<uint8_t> first;
        test::forEachTarget([&](const std::string& target) {
            std::vector<uint8_t> back((per_view + 63) / 64 * 8, 0xff);
            findBackFaces(classes, mask, back);
            if (first.empty()) first = back;
            ASSERT_EQ(back, first) << target;
        });
        for (size_t i = 0; i < per_view; ++i) {
            test::Quad truth = test::trueFacing(mesh.view(), i, eye.point, eye.w);
            if (front == FrontFace::kClockwise) truth = -truth;
            fronts += truth > 0, culled += test::bitOf(first, i);
            // The eye itself is known to its error only: what is as close to edge-on is nobody's.
            if (truth > 0 && test::bitOf(first, i)) {
                const QuadBound doubt{mesh, i, eye};
                ASSERT_LE(truth, doubt.value) << "view " << v << " triangle " << i;
            }
        }
    }
    EXPECT_GT(fronts, culled / 2);
    EXPECT_GT(culled, 50000u);
}

/// Of triangles in the window with normals of all directions, over views of all directions: found / seen from the back.
double recall(double fov_y, int cells, int sectors, bool parallel = false) {
    Random random(92);
    View view;
    view.width = view.height = 1000;
    view.projection = parallel ? orthographic(2.0, 1.0, 0.1, 10.0) : perspective(fov_y, 1.0, 0.1, 10.0);
    const glm::dmat4 m(1.0);
    const glm::dvec3 from(1, 2, 3);
    size_t backs = 0, found = 0;
    for (int v = 0; v < 500; ++v) {
        view.view = lookAt(from, from + test::randomUnit(random), test::randomUnit(random));
        const FacingEye eye = facingEye(view, m);
        const SectorMasks masks(view, m, FrontFace::kCounterClockwise, cells, sectors);
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 p = pointInView(random, view, m, {-1, -1, 1, 1}), n = test::randomUnit(random);
            if (glm::dot(n, eye.point - eye.w * p) > 0) continue;
            ++backs;
            const int sector = masks.sectorOf(glm::vec3(p));
            if (sector < 0) continue;
            const int number = normalClass(n, cells);
            const NormalMask& mask = masks.mask(sector % sectors, sector / sectors);
            found += mask.bytes[static_cast<size_t>(number >> 3)] >> (number & 7) & 1;
        }
    }
    return static_cast<double>(found) / static_cast<double>(backs);
}

TEST(NormalMasks, FindTheSharesThatTheMethodIsKnownFor) {
    const double angle = glm::radians(60.0);
    const double one = recall(angle, 16, 1), two = recall(angle, 16, 2), four = recall(angle, 16, 4);
    const double eight = recall(angle, 16, 8), parallel = recall(angle, 16, 1, true);
    EXPECT_GE(one, 0.36);
    EXPECT_GE(two, 0.61);
    EXPECT_GE(four, 0.77);
    EXPECT_GE(eight, 0.85);
    EXPECT_GE(parallel, 0.93);
    std::printf("found at 60 degrees: %.3f %.3f %.3f %.3f, parallel: %.3f\n", one, two, four, eight, parallel);
}

TEST(NormalMasks, ABoxesMaskHoldsForAllThatIsSeenOfIt) {
    Random random(93);
    const size_t per_view = 500, views = test::casesToMake(1000000) / per_view;
    size_t culled = 0, in_one = 0;
    for (size_t v = 0; v < views && !HasFailure(); ++v) {
        const glm::dmat4 m = randomTransform(random);
        const View view = randomView(random, glm::dvec3(m[3]));
        const FacingEye eye = facingEye(view, m);
        const int cells = 16, sectors = 1 + static_cast<int>(random.below(8));
        const SectorMasks masks(view, m, eye.front, cells, sectors);
        const size_t per_box = 50;
        for (size_t box_number = 0; box_number < per_view / per_box; ++box_number) {
            const glm::dvec3 about = pointInView(random, view, m, {-1, -1, 1, 1});
            const double size = std::ldexp(1.0, -static_cast<int>(random.below(8)));
            Box3f box;
            test::TestMesh mesh;
            while (mesh.indices.size() < 3 * per_box) {
                const glm::dvec3 p = about + test::randomVector(random, size);
                addThrough(random, p, eye, mesh);
            }
            for (const glm::vec3& p : mesh.positions) box.grow(p);
            const NormalClasses classes = makeNormalClasses(mesh.view(), cells);
            const NormalMask of_box = masks.maskOf(box);
            std::vector<uint8_t> back(8);
            findBackFaces(classes, of_box, back);
            for (size_t i = 0; i < per_box; ++i) {
                // Only what is surely seen is judged; a corner tells.
                const int sector = masks.sectorOf(mesh.positions[3 * i]);
                if (sector < 0) continue;
                const auto holds = [&](const NormalMask& mask) {
                    return (mask.bytes[classes.byte[i]] & classes.bit[i]) != 0;
                };
                const bool alone = holds(masks.mask(sector % sectors, sector / sectors));
                const test::Quad truth = test::trueFacing(mesh.view(), i, eye.point, eye.w);
                if (test::bitOf(back, i)) { ASSERT_TRUE(alone); }  // it is one of the box's sectors
                if (truth > 0 && alone) {
                    const QuadBound doubt{mesh, i, eye};
                    ASSERT_LE(truth, doubt.value) << "view " << v << " triangle " << i;
                }
                culled += test::bitOf(back, i), in_one += alone;
            }
        }
    }
    EXPECT_GT(culled, 5000u);
    EXPECT_GT(in_one, culled);
}

TEST(NormalMasks, WhatLiesBesideTheWindowIsInNoSector) {
    View view;
    view.width = view.height = 100;
    view.projection = perspective(glm::radians(90.0), 1.0, 0.1);
    const SectorMasks masks(view, glm::dmat4(1.0), FrontFace::kCounterClockwise, 16, 4);
    EXPECT_TRUE(masks.sectorsOf({{20, 0, -10}, {21, 1, -9}}).empty());
    const SectorMasks::Range middle = masks.sectorsOf({{-0.1f, -0.1f, -10}, {0.1f, 0.1f, -9}});
    EXPECT_EQ(middle.first[0], 1);
    EXPECT_EQ(middle.last[0], 2);
    const SectorMasks::Range behind = masks.sectorsOf({{-1, -1, -1}, {1, 1, 1}});  // holds the eye
    EXPECT_EQ(behind.last[0] - behind.first[0], 3);
    EXPECT_EQ(masks.sectorOf({0, 0, 5}), -1);
    EXPECT_EQ(masks.sectorOf({-9.9f, -9.9f, -10}), 0);
    EXPECT_EQ(masks.sectorOf({9.9f, 9.9f, -10}), 15);
}

TEST(NormalMasks, ATriangleWithoutAreaOrAnUnknownEyeCullsNothing) {
    test::TestMesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    mesh.add({0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    const NormalClasses classes = makeNormalClasses(mesh.view());
    NormalMask all;
    all.bytes.fill(0xff);
    std::vector<uint8_t> back(8);
    EXPECT_EQ(findBackFaces(classes, all, back), 1u);
    EXPECT_EQ(back[0], 0b10);
    CornerRays unknown;
    unknown.error = INFINITY;
    EXPECT_EQ(findBackFaces(classes, makeNormalMask(unknown, FrontFace::kCounterClockwise, 16), back), 0u);
}

}  // namespace
}  // namespace sightline
