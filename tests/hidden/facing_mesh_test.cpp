// Back faces of meshes: how many there are, and that a closed one looks the same without them.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/hidden/render.h"
#include "tests/hidden/made_lists.h"

namespace sightline::test {
namespace {

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;

    DrawItem item() const {
        DrawItem item;
        item.mesh = {positions, indices};
        return item;
    }
};

/// Six faces of two triangles, fronts outward.
Mesh cube() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
    mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

/// A torus with bumps: closed, not convex.
Mesh bumpyTorus(int around = 48, int across = 24) {
    Mesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = i * 6.283185307179586 / around, v = j * 6.283185307179586 / across;
            const double r = 0.45 + 0.12 * std::sin(5 * u + 2 * v);
            mesh.positions.push_back(
                glm::dvec3(std::cos(u) * (1 + r * std::cos(v)), r * std::sin(v), -std::sin(u) * (1 + r * std::cos(v))));
            const auto at = [&](int x, int y) { return uint32_t((x % around) * across + y % across); };
            const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

glm::dvec3 randomDirection(Random& random) {
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 6.283185307179586);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(Facing, HalfOfACubeOrMoreIsBackFacesFromAnyEyeOutside) {
    const Mesh mesh = cube();
    Random random(41);
    int fewest = 12, faces[4] = {};
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 eye = random.uniform(1, 6) * randomDirection(random) * glm::dvec3(1, 1, 1);
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
    for (const Mesh& mesh : {cube(), bumpyTorus()}) {
        Random random(42);
        const double triangles = double(mesh.indices.size() / 3);
        double parallel = 0, near = 0;
        const int views = 4000;
        for (int i = 0; i < views; ++i) {
            const glm::dvec3 direction = randomDirection(random);
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

HiddenImage paintedIds(const std::vector<DrawItem>& items, const View& view, const ProjectorSettings& settings) {
    const DrawList list(items);
    Projector projector(view, {view.width, view.height, 0, 1, {}}, settings);
    HiddenImage image;
    image.width = view.width;
    image.height = view.height;
    const size_t samples = size_t{view.width} * view.height;
    image.surface.assign(samples, HiddenImage::kNone);
    std::vector<double> nearest(samples, -std::numeric_limits<double>::infinity());
    for (const ScreenPolygon& polygon : projectAll(list, projector))
        scanPolygon(polygon.outline(), 0, int32_t(view.height), int32_t(view.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        for (int32_t i = begin; i < end; ++i) {
                            const size_t at = size_t(row) * view.width + size_t(i);
                            const double nearness = polygon.depth.at(row, i);
                            if (nearness <= nearest[at]) continue;
                            nearest[at] = nearness;
                            image.surface[at] = polygon.surface;
                        }
                    });
    image.counters.geometry = projector.counters();
    return image;
}

/// Views of a mesh at the origin: all around, parallel ones too.
View viewOf(Random& random, int i) {
    View view;
    view.width = 96;
    view.height = 64;
    view.view = lookAt(random.uniform(2.5, 5) * randomDirection(random), {0.1, 0, 0}, {0, 1, 0});
    view.projection = i % 3 == 2 ? orthographic(4, 1.5, 0.1, 20) : perspective(1.0, 1.5, 0.1, i % 3 ? 30 : INFINITY);
    return view;
}

TEST(Facing, AClosedMeshLooksTheSameWithAndWithoutItsBackFaces) {
    const Mesh mesh = bumpyTorus();
    Random random(43);
    for (int i = 0; i < 60; ++i) {
        DrawItem item = mesh.item();
        if (i % 2) item.transform[0][0] = -1;  // mirrored
        ProjectorSettings all;
        all.cull_back_faces = false;
        const View view = viewOf(random, i);
        const HiddenImage with = paintedIds({item}, view, all), without = paintedIds({item}, view, {});
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
    const Mesh mesh = bumpyTorus();
    Random random(44);
    for (int i = 0; i < 60; ++i) {
        DrawItem item = mesh.item();
        if (i % 2) item.transform[1][1] = -1.5;
        View view = viewOf(random, i);
        if (i % 5 == 4) view.projection[0] = -view.projection[0];  // a mirrored image
        std::vector<HiddenImage> images;
        for (const FacingTest test : {FacingTest::kHomogeneous, FacingTest::kEyePlane, FacingTest::kScreenArea}) {
            ProjectorSettings settings;
            settings.facing_test = test;
            images.push_back(paintedIds({item}, view, settings));
            // Clockwise fronts of a mesh with all triangles turned.
            Mesh turned = mesh;
            for (size_t t = 0; t < turned.indices.size(); t += 3)
                std::swap(turned.indices[t + 1], turned.indices[t + 2]);
            DrawItem turned_item = turned.item();
            turned_item.transform = item.transform;
            settings.front_face = FrontFace::kClockwise;
            images.push_back(paintedIds({turned_item}, view, settings));
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
