// Bounds of the distance of surfaces, held against dense samples and against what geometry says.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/lod/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/prepare/lod/sampled_distance.h"
#include "tests/prepare/occluder/patch_laws.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

using test::TestMesh;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

Box3d boxOf(const MeshView& a, const MeshView& b) {
    Box3d box;
    for (const MeshView* mesh : {&a, &b})
        for (const uint32_t vertex : mesh->indices) box.grow(glm::dvec3(mesh->positions[vertex]));
    return box;
}

/// The bounds hold the true distance, and are as near to one another as was asked for.
void expectDistance(const TestMesh& a, const TestMesh& b, double truth, const DistanceLimits& limits = {}) {
    const SurfaceDistance found = surfaceDistance(a.view(), b.view(), limits);
    const Box3d box = boxOf(a.view(), b.view());
    const double reach = std::max(glm::length(box.min), glm::length(box.max));
    EXPECT_LE(found.lower, truth + 1e-12 * reach);
    EXPECT_GE(found.upper, truth - 1e-12 * reach);
    EXPECT_LE(found.upper,
              (1 + limits.relative) * found.lower + limits.absolute * glm::length(box.size()) + 1e-12 * reach);
}

TestMesh square(double size, double height) {
    const float s = float(size), h = float(height);
    TestMesh mesh;
    mesh.add({{0, 0, h}, {s, 0, h}, {s, s, h}, {0, s, h}});
    return mesh;
}

/// A grid of n by n quads over a square; height(x, y) with x, y in [0, 1].
template <class Height>
TestMesh grid(uint32_t n, double size, Height height) {
    TestMesh mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.positions.push_back({size * x / n, size * y / n, height(double(x) / n, double(y) / n)});
    mesh.addGrid(n + 1, n + 1);
    return mesh;
}

/// Triangles of all shapes: needles, segments and points among them, some in common planes.
TestMesh randomSoup(Random& random, int triangles) {
    TestMesh mesh;
    for (int i = 0; i < triangles; ++i) {
        glm::dvec3 corner[3];
        corner[0] = test::randomVector(random, 1.0);
        for (int k = 1; k < 3; ++k) corner[k] = corner[0] + test::randomVector(random, 0.8);
        const uint64_t kind = random.below(8);
        if (kind == 0) corner[2] = corner[1];
        if (kind == 1) corner[2] = corner[1] = corner[0];
        if (kind == 2) corner[2] = corner[0] + random.uniform(-1, 2) * (corner[1] - corner[0]);
        if (kind == 3) corner[2] = corner[1] + test::randomVector(random, 1e-6);
        if (kind == 4)
            for (glm::dvec3& p : corner) p.z = 0.25;
        mesh.add(glm::vec3(corner[0]), glm::vec3(corner[1]), glm::vec3(corner[2]));
    }
    return mesh;
}

TestMesh moved(const TestMesh& mesh, const glm::dmat4& by) {
    TestMesh out = mesh;
    for (glm::vec3& p : out.positions) p = glm::vec3(by * glm::dvec4(p, 1.0));
    return out;
}

TEST(SurfaceDistance, IsZeroForTheSameTriangles) {
    const Soup ball = makeBall(3, 8);
    Soup other;
    for (size_t t = ball.indices.size(); t > 0; t -= 3)  // the other way round, in the other order
        other.add(ball.positions[ball.indices[t - 1]], ball.positions[ball.indices[t - 3]],
                  ball.positions[ball.indices[t - 2]]);
    const SurfaceDistance found = surfaceDistance(ball.view(), other.view());
    EXPECT_EQ(found.lower, 0);
    EXPECT_EQ(found.upper, 0);
    EXPECT_EQ(found.cuts, 0u);
}

TEST(SurfaceDistance, OfParallelSquaresIsTheirGap) {
    expectDistance(square(1, 0), square(1, 0.25), 0.25);
    expectDistance(square(1, 0), square(1, 1e-3), double(1e-3f));
    // The larger one's corner is farther from the smaller one than the planes are.
    expectDistance(square(1, 0), square(2, 0.5), std::sqrt(1 + 1 + 0.25));
}

TEST(SurfaceDistance, OfASpikeIsItsHeight) {
    TestMesh spike = square(1, 0);
    spike.add({0.5f, 0.5f, 0}, {0.5001f, 0.5f, 0}, {0.5f, 0.5f, 3});
    expectDistance(square(1, 0), spike, 3);
}

TEST(SurfaceDistance, OfAHoleIsTheWayToItsRim) {
    TestMesh frame;
    for (const auto& [x, y, w, h] :
         std::vector<std::array<float, 4>>{{0, 0, 4, 1}, {0, 3, 4, 1}, {0, 1, 1, 2}, {3, 1, 1, 2}})
        frame.add({{x, y, 0}, {x + w, y, 0}, {x + w, y + h, 0}, {x, y + h, 0}});
    expectDistance(square(4, 0), frame, 1);
    // All corners of the hole lie on the other surface: nothing but its inside is away.
    expectDistance(square(4, 0), frame, 1, {.relative = 1e-3, .absolute = 0});
}

TEST(SurfaceDistance, OfAnotherTessellationOfAPlaneIsNothing) {
    const auto flat = [](double, double) { return 0.0; };
    const TestMesh coarse = square(1, 0);
    expectDistance(coarse, grid(7, 1, flat), 0);
    TestMesh fine = grid(12, 1, flat), other = grid(7, 1, flat);
    // Inner vertices go elsewhere in the plane.
    Random random(5);
    for (TestMesh* mesh : {&fine, &other})
        for (glm::vec3& p : mesh->positions)
            if (p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1)
                p += glm::vec3(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0);
    expectDistance(fine, other, 0);
    const SurfaceDistance found = surfaceDistance(fine.view(), other.view(), {.absolute = 1e-9});
    EXPECT_LE(found.upper, 1.5e-9);
    EXPECT_LT(found.cuts, 30 * (fine.view().triangles() + other.view().triangles()));
}

TEST(SurfaceDistance, OfAPrismFromAFinerOneIsTheSagitta) {
    const auto tube = [](uint32_t sides) {
        TestMesh mesh;
        for (int y = 0; y < 2; ++y)
            for (uint32_t i = 0; i < sides; ++i)
                mesh.positions.push_back({2 * std::cos(2 * kPi * i / sides), 3 * y, 2 * std::sin(2 * kPi * i / sides)});
        mesh.addGrid(sides, 2, true);
        return mesh;
    };
    for (const uint32_t sides : {3u, 4u, 8u, 24u}) {
        const double sagitta = 2 * (1 - std::cos(kPi / sides));
        const SurfaceDistance found = surfaceDistance(tube(sides).view(), tube(2 * sides).view());
        EXPECT_NEAR(found.lower, sagitta, 0.05 * sagitta + 2e-5);
        EXPECT_GE(found.upper, sagitta - 1e-6);  // corners were rounded to float
        EXPECT_LE(found.upper, 1.05 * sagitta + 2e-5);
    }
}

TEST(SurfaceDistance, LiesBetweenTheSampledBounds) {
    Random random(7);
    const size_t cases = test::casesToMake(60, 3000);
    for (size_t i = 0; i < cases; ++i) {
        SCOPED_TRACE(::testing::Message() << "case " << i);
        const TestMesh a = randomSoup(random, 1 + int(random.below(10)));
        TestMesh b = randomSoup(random, 1 + int(random.below(10)));
        if (random.below(2))
            b = moved(a,
                      {1, 0, 0, 0, 0, 1, random.uniform(-0.1, 0.1), 0, 0, 0, 1, 0, 0, 0, random.uniform(-0.1, 0.1), 1});
        const test::SampledDistance truth = test::sampleDistance(a.view(), b.view(), 24);
        const DistanceLimits limits{.relative = random.below(2) ? 0.05 : 0.005};
        const SurfaceDistance found = surfaceDistance(a.view(), b.view(), limits);
        EXPECT_GE(found.upper, truth.least);
        EXPECT_LE(found.lower, truth.most);
        EXPECT_LE(found.lower, found.upper);
        const double diagonal = glm::length(boxOf(a.view(), b.view()).size());
        EXPECT_LE(found.upper, (1 + limits.relative) * found.lower + limits.absolute * diagonal + 1e-11);
    }
}

TEST(SurfaceDistance, FindsAHoleWhereverItIs) {
    // One triangle of a plane is missing: nothing but its inside is away from the surface.
    for (uint64_t seed = 0; seed < 24; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        Random random(seed);
        TestMesh fine = grid(5, 1, [](double, double) { return 0.0; });
        for (glm::vec3& p : fine.positions)
            if (p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1)
                p += glm::vec3(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), 0);
        const auto hole = std::ptrdiff_t(3 * random.below(fine.view().triangles()));
        fine.indices.erase(fine.indices.begin() + hole, fine.indices.begin() + hole + 3);
        const TestMesh coarse = square(1, 0);
        const double truth = test::sampleOneWay(coarse.view(), fine.view(), 100).least;
        const SurfaceDistance found = surfaceDistance(coarse.view(), fine.view());
        EXPECT_GE(found.upper, truth);
        EXPECT_LE(found.lower, truth + 0.015);
        EXPECT_LE(found.upper, 1.05 * found.lower + 1.5e-6);
    }
}

TEST(SurfaceDistance, LooksAtAllSidesOfAVertex) {
    // A fan around a vertex within a triangle; a part of one blade is missing.
    for (size_t blade = 0; blade < 3; ++blade) {
        const glm::vec3 corner[3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, middle(1.25f, 1.25f, 0);
        TestMesh whole, fan;
        whole.add(corner[0], corner[1], corner[2]);
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec3 &a = corner[k], &b = corner[(k + 1) % 3];
            fan.add(middle, a, k == blade ? a + 0.25f * (b - a) : b);
        }
        const test::SampledDistance truth = test::sampleDistance(whole.view(), fan.view(), 200);
        const SurfaceDistance found = surfaceDistance(whole.view(), fan.view());
        EXPECT_GT(truth.least, 0.5);
        EXPECT_GE(found.upper, truth.least);
        EXPECT_LE(found.lower, truth.most);
    }
}

TEST(SurfaceDistance, TakesNoTriangleForAnotherThatSharesASide) {
    for (int spike = 2; spike < 40; ++spike) {
        TestMesh fan;
        for (int i = 0; i < 100; ++i) fan.add({0, 0, 0}, {0, 1, 0}, {1, std::cos(float(i)), std::sin(float(i))});
        TestMesh other = fan;
        other.add({0, 0, 0}, {0, 1, 0}, {float(spike), 0, 0});
        EXPECT_GE(surfaceDistance(fan.view(), other.view()).upper, spike - 1.5);
    }
}

TEST(SurfaceDistance, OfBumpySurfacesLiesBetweenTheSampledBounds) {
    Random random(9);
    for (const double bumps : {0.3, 0.03, 0.001}) {
        const auto height = [&](double, double) { return bumps * random.uniform(); };
        const TestMesh a = grid(9, 1, height), b = grid(6, 1, height);
        const test::SampledDistance truth = test::sampleDistance(a.view(), b.view(), 16);
        const SurfaceDistance found = surfaceDistance(a.view(), b.view());
        EXPECT_GE(found.upper, truth.least);
        EXPECT_LE(found.lower, truth.most);
        EXPECT_LE(found.upper, 1.05 * found.lower + 1.5e-6);
    }
}

TEST(SurfaceDistance, IsTheSameBothWaysAndWhereverTheSurfacesLie) {
    Random random(11);
    for (int i = 0; i < 20; ++i) {
        const TestMesh a = randomSoup(random, 8), b = randomSoup(random, 8);
        const SurfaceDistance there = surfaceDistance(a.view(), b.view()), back = surfaceDistance(b.view(), a.view());
        EXPECT_LE(there.lower, back.upper);
        EXPECT_LE(back.lower, there.upper);
        const glm::dvec3 x = test::randomUnit(random), y = glm::normalize(glm::cross(x, test::randomUnit(random)));
        const glm::dmat4 turn(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(glm::cross(x, y), 0),
                              glm::dvec4(5, -3, 8, 1));
        const SurfaceDistance turned = surfaceDistance(moved(a, turn).view(), moved(b, turn).view());
        EXPECT_LE(there.lower, turned.upper + 1e-5);  // the turned corners were rounded to float
        EXPECT_LE(turned.lower, there.upper + 1e-5);
        // A power of two changes no bit but the exponents.
        glm::dmat4 scale(1.0);
        for (int axis = 0; axis < 3; ++axis) scale[axis][axis] = 0x1p40;
        const SurfaceDistance scaled = surfaceDistance(moved(a, scale).view(), moved(b, scale).view());
        EXPECT_EQ(scaled.upper, 0x1p40 * there.upper);
        EXPECT_EQ(scaled.lower, 0x1p40 * there.lower);
        EXPECT_EQ(scaled.cuts, there.cuts);
    }
}

TEST(SurfaceDistance, TakesPointsAndSegmentsForWhatTheyAre) {
    TestMesh point, segment, other;
    point.add({1, 0, 0}, {1, 0, 0}, {1, 0, 0});
    segment.add({0, 0, 0}, {4, 0, 0}, {2, 0, 0});
    other.add({0, 1, 0}, {4, 1, 0}, {4, 1, 0});
    expectDistance(point, point, 0);
    expectDistance(point, segment, 3);
    expectDistance(segment, other, 1);
    expectDistance(point, other, std::sqrt(10));
    expectDistance(segment, square(4, 0), 4);
}

TEST(SurfaceDistance, IsInfiniteWhereItIsNotKnown) {
    const TestMesh mesh = square(1, 0);
    for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        TestMesh broken = mesh;
        broken.add({0, 0, 0}, {1, 0, 0}, {1, wrong, 0});
        EXPECT_EQ(surfaceDistance(mesh.view(), broken.view()).upper, kInfinity);
        EXPECT_EQ(surfaceDistance(broken.view(), mesh.view()).lower, kInfinity);
        EXPECT_EQ(surfaceDistance(broken.view(), broken.view()).upper, kInfinity);
        TestMesh unused = mesh;
        unused.positions.push_back({wrong, 0, 0});
        EXPECT_EQ(surfaceDistance(mesh.view(), unused.view()).upper, 0);
    }
    EXPECT_EQ(surfaceDistance(TestMesh().view(), mesh.view()).upper, kInfinity);
    EXPECT_EQ(surfaceDistance(mesh.view(), TestMesh().view()).lower, kInfinity);
    EXPECT_EQ(surfaceDistance(TestMesh().view(), TestMesh().view()).upper, 0);
}

TEST(SurfaceDistance, IsOnlyLooserWhereTheCutsRunOut) {
    Random random(13);
    for (int i = 0; i < 20; ++i) {
        const TestMesh a = randomSoup(random, 8), b = randomSoup(random, 8);
        const double least = test::sampleDistance(a.view(), b.view(), 12).least;
        double last = kInfinity;
        for (const uint32_t cuts : {0u, 1u, 2u, 4u, 64u}) {
            const SurfaceDistance found = surfaceDistance(a.view(), b.view(), {.relative = 0.001, .cuts = cuts});
            EXPECT_LE(found.cuts, 1016u * cuts);
            EXPECT_GE(found.upper, least);
            EXPECT_LE(found.upper, last);
            last = found.upper;
        }
    }
}

TEST(SurfaceDistance, HoldsForTheLargestAndTheSmallestNumbers) {
    Random random(17);
    for (const double size : {3e38, 1e-20, 1e-42}) {
        TestMesh a, b;
        a.add(glm::vec3(0), glm::vec3(size, 0, 0), glm::vec3(0, size, 0));
        b.add(glm::vec3(0, 0, size / 2), glm::vec3(size, 0, size / 2), glm::vec3(0, size, size / 2));
        const SurfaceDistance found = surfaceDistance(a.view(), b.view());
        const double truth = double(b.positions[0].z);
        EXPECT_GE(found.upper, truth);
        EXPECT_LE(found.lower, truth);
        EXPECT_NEAR(found.upper, truth, 1e-5 * size);
        EXPECT_NEAR(found.lower, truth, 1e-5 * size);
    }
    // Far from the origin.
    const TestMesh a = moved(square(1, 0), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1 << 20, 1 << 21, 0, 1});
    const TestMesh b = moved(square(1, 0.25), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1 << 20, 1 << 21, 0, 1});
    expectDistance(a, b, 0.25);
}

TEST(TriangleTree, FindsTheNearestOfAll) {
    Random random(19);
    for (int round = 0; round < 20; ++round) {
        const TestMesh mesh = randomSoup(random, 1 + int(random.below(60)));
        const DistanceSurface surface(mesh.view());
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 p = test::randomVector(random, random.below(2) ? 1.0 : 20.0);
            const double truth = test::distanceToMesh(p, mesh.view());
            const NearTriangle found = surface.tree().nearest(p, {kInfinity, 0});
            EXPECT_NEAR(std::sqrt(found.squared), truth, 1e-7);
            EXPECT_EQ(squaredDistance(surface.corners(found.triangle), p), found.squared);
            const double least = surface.tree().leastDistance(p, std::sqrt(found.squared));
            EXPECT_LE(least, truth + 1e-13);
            EXPECT_NEAR(least, truth, 1e-5);
        }
    }
}

TEST(TriangleTree, ProvesItsDistancesOfNeedles) {
    // Close above a needle rounding decides where the nearest point of it is.
    Random random(23);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 along = test::randomUnit(random);
        const glm::dvec3 across = glm::normalize(glm::cross(along, test::randomUnit(random)));
        const glm::vec3 a(test::randomVector(random, 1.0));
        TestMesh mesh;
        mesh.add(a, a + glm::vec3(along),
                 a + glm::vec3(0.5 * along + random.uniform(0, random.below(2) ? 1e-3 : 1e-6) * across));
        const DistanceSurface surface(mesh.view());
        const TriangleCorners& t = surface.corners(0);
        const glm::dvec3 normal = glm::cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
        if (!(glm::length(normal) > 0)) continue;
        const double height = random.uniform(0, 1e-7);
        const glm::dvec3 p = (t.at[0] + t.at[1] + t.at[2]) / 3.0 + height * glm::normalize(normal);
        const double found = std::sqrt(surface.tree().nearest(p, {kInfinity, 0}).squared);
        const double least = surface.tree().leastDistance(p, found);
        EXPECT_LE(least, height + 1e-14);
        EXPECT_GE(found, height - 1e-14);
        EXPECT_NEAR(least, height, 1e-9);
        EXPECT_NEAR(found, height, 1e-9);
    }
}

}  // namespace
}  // namespace sightline
