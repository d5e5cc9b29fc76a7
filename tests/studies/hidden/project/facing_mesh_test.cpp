// Back faces of meshes: how many there are, and that a closed one looks the same without them.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/render.h"
#include "tests/studies/hidden/made_lists.h"
#include "tests/support/random.h"

namespace sightline::test {
using namespace studies;
namespace {

DrawItem itemOf(const TestMesh& mesh) {
    DrawItem item;
    item.mesh = mesh.view();
    return item;
}

/// A torus with bumps: closed, not convex.
TestMesh bumpyTorus(int around = 48, int across = 24) {
    TestMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = i * 6.283185307179586 / around, v = j * 6.283185307179586 / across;
            const double r = 0.45 + 0.12 * std::sin(5 * u + 2 * v);
            mesh.positions.push_back(
                glm::dvec3(std::cos(u) * (1 + r * std::cos(v)), r * std::sin(v), -std::sin(u) * (1 + r * std::cos(v))));
            const auto at = [&](int x, int y) { return uint32_t((x % around) * across + y % across); };
            const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            mesh.fan({a, b, c, d});
        }
    return mesh;
}

TEST(Facing, HalfOfACubeOrMoreIsBackFacesFromAnyEyeOutside) {
    const TestMesh mesh = boxMesh(glm::vec3(-1), glm::vec3(1));
    Random random(41);
    int fewest = 12, faces[4] = {};
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 eye = random.uniform(1, 6) * randomUnit(random) * glm::dvec3(1, 1, 1);
        if (std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)}) <= 1) continue;
        int back = 0;
        for (size_t t = 0; t < mesh.indices.size(); t += 3)
            back += eyeFacing(mesh.positions[mesh.indices[t]], mesh.positions[mesh.indices[t + 1]],
                              mesh.positions[mesh.indices[t + 2]], eye) <= 0;
        ASSERT_GE(back, 6) << "case " << i;
        ASSERT_EQ(back % 2, 0) << "case " << i;
        fewest = std::min(fewest, back);
        ++faces[(12 - back) / 2];
    }
    std::printf("a cube shows 1, 2 or 3 faces: %d, %d and %d times\n", faces[1], faces[2], faces[3]);
    EXPECT_EQ(fewest, 6);
    EXPECT_EQ(faces[0], 0);
}

TEST(Facing, HalfOfAClosedMeshIsBackFacesInTheMeanOfParallelViews) {
    for (const TestMesh& mesh : {boxMesh(glm::vec3(-1), glm::vec3(1)), bumpyTorus()}) {
        Random random(42);
        const double triangles = double(mesh.indices.size() / 3);
        double parallel = 0, near = 0;
        const int views = 4000;
        for (int i = 0; i < views; ++i) {
            const glm::dvec3 direction = randomUnit(random);
            int back = 0, back_near = 0;
            for (size_t t = 0; t < mesh.indices.size(); t += 3) {
                const glm::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                                 c = mesh.positions[mesh.indices[t + 2]];
                back += parallelFacing(faceNormal(a, b, c), direction) <= 0;
                back_near += eyeFacing(a, b, c, -5.2 * direction) <= 0;
            }
            parallel += back / triangles / views;
            near += back_near / triangles / views;
        }
        std::printf("%4.0f triangles: %.2f %% back faces in parallel views, %.2f %% from three radii\n", triangles,
                    100 * parallel, 100 * near);
        // In opposite directions, what is front is back: the mean over both is a half but for what is edge-on.
        EXPECT_NEAR(parallel, 0.5, 0.01);
        EXPECT_GT(near, parallel);
    }
}

/// Views of a mesh at the origin: all around, parallel ones too.
View viewOf(Random& random, int i) {
    View view;
    view.width = 96;
    view.height = 64;
    view.view = lookAt(random.uniform(2.5, 5) * randomUnit(random), {0.1, 0, 0}, {0, 1, 0});
    view.projection = i % 3 == 2 ? orthographic(4, 1.5, 0.1, 20) : perspective(1.0, 1.5, 0.1, i % 3 ? 30 : INFINITY);
    return view;
}

TEST(Facing, AClosedMeshLooksTheSameWithAndWithoutItsBackFaces) {
    const TestMesh mesh = bumpyTorus();
    Random random(43);
    for (int i = 0; i < 60; ++i) {
        DrawItem item = itemOf(mesh);
        if (i % 2) item.transform[0][0] = -1;  // mirrored
        const View view = viewOf(random, i);
        const HiddenImage with = nearestSurfaces(DrawList(std::span(&item, 1)), view, {.cull_back_faces = false}),
                          without = nearestSurfaces(DrawList(std::span(&item, 1)), view, {});
        uint64_t differing = 0, covered = 0;
        for (size_t at = 0; at < with.surface.size(); ++at) {
            differing += with.surface[at] != without.surface[at];
            covered += with.surface[at] != HiddenImage::kNone;
        }
        // On a silhouette, front and back share an edge, and a sample there may lie on either.
        EXPECT_LE(differing, 2u) << "case " << i;
        EXPECT_GT(covered, 500u) << "case " << i;
        EXPECT_GT(without.counters.geometry.back_facing, mesh.indices.size() / 3 / 3) << "case " << i;
        EXPECT_LE(with.counters.geometry.back_facing, 2u) << "case " << i;
    }
}

TEST(Facing, TestsAndFrontsOfTheProjectorAgree) {
    const TestMesh mesh = bumpyTorus();
    Random random(44);
    for (int i = 0; i < 60; ++i) {
        DrawItem item = itemOf(mesh);
        if (i % 2) item.transform[1][1] = -1.5;
        View view = viewOf(random, i);
        if (i % 5 == 4) view.projection[0] = -view.projection[0];  // a mirrored image
        std::vector<HiddenImage> images;
        for (const FacingTest test : {FacingTest::kHomogeneous, FacingTest::kEyePlane, FacingTest::kScreenArea}) {
            ProjectorSettings settings{.facing_test = test};
            images.push_back(nearestSurfaces(DrawList(std::span(&item, 1)), view, settings));
            // Clockwise fronts of a mesh with all triangles turned.
            TestMesh turned = mesh;
            for (size_t t = 0; t < turned.indices.size(); t += 3)
                std::swap(turned.indices[t + 1], turned.indices[t + 2]);
            DrawItem turned_item = itemOf(turned);
            turned_item.transform = item.transform;
            settings.front_face = FrontFace::kClockwise;
            images.push_back(nearestSurfaces(DrawList(std::span(&turned_item, 1)), view, settings));
        }
        for (const HiddenImage& image : images) {
            EXPECT_EQ(image.surface, images[0].surface) << "case " << i;
            const ProjectorCounters& counters = image.counters.geometry;
            EXPECT_EQ(counters.triangles,
                      counters.rejected + counters.back_facing + counters.accepted + counters.clipped);
        }
    }
}

}  // namespace
}  // namespace sightline::test
