// Joined objects are the same triangles with the same materials in the same places; what must stay stays.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/merge.h"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/solids.h"
#include "tests/support/drawn_triangles.h"

namespace sightline::test {
namespace {

/// Unit cubes of two materials in a row, two units apart.
Scene cubesInARow(int count) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].name = "brick";
    for (uint32_t material = 0; material < 2; ++material) {
        city::MeshBuilder mesh;
        city::addBox(mesh, material, {0, 0, 0}, {1, 1, 1});
        scene.meshes.push_back(mesh.finish("cube"));
    }
    for (int i = 0; i < count; ++i) {
        SceneObject object;
        object.key = static_cast<uint64_t>(i);
        object.mesh = static_cast<uint32_t>(i % 2);
        object.transform[3] = glm::dvec4(2.0 * i, 0, 0, 1);
        scene.objects.push_back(object);
    }
    return scene;
}

/// Six times the volume that all triangles enclose: fronts outward count up, turned ones down.
double enclosed(const Scene& scene) {
    double sum = 0;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const double side = glm::determinant(glm::dmat3(object.transform)) < 0 ? -1 : 1;
        for (size_t t = 0; t < mesh.triangles(); ++t) {
            glm::dvec3 p[3];
            for (size_t k = 0; k < 3; ++k)
                p[k] =
                    glm::dvec3(object.transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]), 1.0));
            sum += side * glm::dot(p[0], glm::cross(p[1], p[2]));
        }
    }
    return sum;
}

void expectTables(const Scene& scene) {
    std::set<uint64_t> keys;
    std::set<uint32_t> used;
    for (const SceneObject& object : scene.objects) {
        EXPECT_TRUE(keys.insert(object.key).second) << "key " << object.key << " twice";
        ASSERT_LT(object.mesh, scene.meshes.size());
        used.insert(object.mesh);
    }
    EXPECT_EQ(used.size(), scene.meshes.size()) << "meshes that nothing uses";
    for (const Mesh& mesh : scene.meshes) {
        uint32_t next = 0;
        for (const Primitive& primitive : mesh.primitives) {
            EXPECT_EQ(primitive.first_triangle, next);
            next += primitive.triangle_count;
        }
        EXPECT_EQ(next, mesh.triangles());
        for (const glm::vec3& p : mesh.positions) {
            Box3d grown = mesh.bounds;
            grown.grow(glm::dvec3(p));
            EXPECT_TRUE(grown.min == mesh.bounds.min && grown.max == mesh.bounds.max);
        }
    }
}

TEST(MergeSmall, JoinsWhatIsNear) {
    const Scene scene = cubesInARow(16);
    const MergedScene merged = mergeSmall(scene, {.triangles = 64, .cubes = 4});
    expectTables(merged.scene);
    EXPECT_EQ(merged.small, 16u);
    EXPECT_EQ(trianglesDrawn(merged.scene), trianglesDrawn(scene));
    for (const Mesh& mesh : merged.scene.meshes) EXPECT_LE(mesh.primitives.size(), 2u) << "one a material";
}

TEST(MergeSmall, LargeAndLonelyOnesStay) {
    const Scene scene = cubesInARow(8);
    const MergedScene none = mergeSmall(scene, {.triangles = 12, .cubes = 4});  // cubes have twelve
    EXPECT_EQ(none.small, 0u);
    EXPECT_EQ(none.scene.objects.size(), 8u);
    const MergedScene lonely = mergeSmall(scene, {.triangles = 64, .cubes = 1000});
    EXPECT_EQ(lonely.joined, 0u);
    EXPECT_EQ(trianglesDrawn(lonely.scene), trianglesDrawn(scene));
    EXPECT_EQ(mergeSmall(Scene(), {}).small, 0u);
}

TEST(MergeSmall, MirroredOnesKeepTheirFronts) {
    Scene scene = cubesInARow(6);
    for (size_t i = 0; i < 6; i += 2) scene.objects[i].transform[1] *= -1;
    const MergedScene merged = mergeSmall(scene, {.triangles = 64, .cubes = 1});
    EXPECT_EQ(merged.small, 6u);
    EXPECT_EQ(merged.joined, 1u);
    EXPECT_NEAR(enclosed(scene), 36, 1e-9);
    EXPECT_NEAR(enclosed(merged.scene), 36, 1e-9);
}

TEST(MergeSmall, WhatHasNoFinitePlaceOrDeformsStays) {
    Scene scene = cubesInARow(6);
    scene.objects[1].transform[3].x = std::numeric_limits<double>::quiet_NaN();
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes.back().deforms = true;
    scene.objects[2].mesh = 2;
    const MergedScene merged = mergeSmall(scene, {.triangles = 64, .cubes = 1});
    EXPECT_EQ(merged.small, 4u);
    ASSERT_EQ(merged.scene.objects.size(), 3u);
    EXPECT_EQ(merged.scene.objects[0].key, 1u);
    EXPECT_EQ(merged.scene.objects[1].key, 2u);
    EXPECT_EQ(merged.scene.objects[2].key, 6u);
}

TEST(MergeSmall, DoorsStayAndKeepTheirPortals) {
    const Scene scene = makeBuilding(1, 1);
    const MergedScene merged = mergeSmall(scene, {.triangles = 1000, .cubes = 8});
    expectTables(merged.scene);
    EXPECT_GT(merged.small, scene.objects.size() / 4);
    ASSERT_EQ(merged.scene.portals.size(), scene.portals.size());
    size_t doors = 0;
    for (size_t i = 0; i < scene.portals.size(); ++i) {
        const uint32_t before = scene.portals[i].door, after = merged.scene.portals[i].door;
        ASSERT_EQ(before < scene.objects.size(), after < merged.scene.objects.size());
        if (before >= scene.objects.size()) continue;
        EXPECT_EQ(scene.objects[before].key, merged.scene.objects[after].key);
        ++doors;
    }
    EXPECT_GT(doors, 0u);
    EXPECT_EQ(drawnTriangles(merged.scene), drawnTriangles(scene));
}

}  // namespace
}  // namespace sightline::test
