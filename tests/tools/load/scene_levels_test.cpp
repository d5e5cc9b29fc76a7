// Levels of detail that scenes bring with them: found by names, joined to meshes, measured, and told to the world.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/scene_levels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sightline/base/random.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/mesh_lods.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace tools;
namespace {

Mesh meshOf(const TestMesh& from, const std::string& name = "") {
    Mesh mesh;
    mesh.name = name;
    mesh.positions = from.positions;
    mesh.indices = from.indices;
    for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    mesh.primitives.push_back({0, static_cast<uint32_t>(mesh.triangles()), 0});
    return mesh;
}

/// A flat square of so many cells along a side, in the unit square of the plane z = 0.
Mesh sheet(uint32_t cells) {
    TestMesh mesh;
    for (uint32_t y = 0; y <= cells; ++y)
        for (uint32_t x = 0; x <= cells; ++x)
            mesh.positions.emplace_back(static_cast<float>(x) / static_cast<float>(cells),
                                        static_cast<float>(y) / static_cast<float>(cells), 0.0f);
    mesh.addGrid(cells + 1, cells + 1);
    return meshOf(mesh);
}

struct SceneMaker {
    Scene scene;
    SceneMaker() { scene.materials.resize(1); }
    void add(const std::string& name, const Mesh& mesh, const glm::dvec3& at = glm::dvec3(0.0), uint32_t parent = ~0u) {
        scene.meshes.push_back(mesh);
        scene.nodes.push_back({name, parent});
        SceneObject object;
        object.key = scene.objects.size();
        object.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
        object.transform[3] = glm::dvec4(at, 1.0);
        object.name = name;
        object.node = static_cast<uint32_t>(scene.nodes.size() - 1);
        scene.objects.push_back(object);
    }
};

std::vector<uint64_t> keysOf(const Scene& scene) {
    std::vector<uint64_t> keys;
    for (const SceneObject& object : scene.objects) keys.push_back(object.key);
    return keys;
}

TEST(SceneLevels, NamesTellWhichObjectsAreLevelsOfWhich) {
    SceneMaker made;
    made.add("Tree_LOD1", sheet(4));
    made.add("tree_lod0", sheet(8), {1, 0, 0});
    made.add("Tree_LOD2", sheet(1));
    made.add("Rock", sheet(8));
    made.add("Rock_LOD1", sheet(2));
    made.add("Alone_LOD1", sheet(2));  // has no finest level
    made.add("Twice_LOD0", sheet(2));
    made.add("Twice_LOD1", sheet(2));
    made.add("Twice_LOD1", sheet(2));  // which one?
    made.add("House", sheet(2));
    made.add("House_LOD1", sheet(2), {0, 0, 0}, 9);  // below another node
    made.add("Ladder_LOD1x", sheet(2));
    made.add("Ladder_LOD0", sheet(2));
    EXPECT_EQ(takeNamedLevels(made.scene), 3u);
    EXPECT_EQ(keysOf(made.scene), (std::vector<uint64_t>{1, 3, 5, 6, 7, 8, 9, 10, 11, 12}));
    ASSERT_EQ(made.scene.levels.size(), 3u);
    EXPECT_EQ(made.scene.levels[0].object, 0u);
    EXPECT_EQ(made.scene.levels[0].mesh, 0u);
    EXPECT_EQ(made.scene.levels[0].transform[3].x, -1.0) << "the level stands one to the left of the object";
    EXPECT_EQ(made.scene.levels[1].mesh, 2u);
    EXPECT_EQ(made.scene.levels[2].object, 1u);
    EXPECT_EQ(takeNamedLevels(made.scene), 0u);
}

TEST(SceneLevels, DoorsStayAndKeepTheirPlaces) {
    SceneMaker made;
    made.add("Wall_LOD1", sheet(1));
    made.add("Wall_LOD0", sheet(4));
    made.add("Door_LOD0", sheet(4));
    made.add("Door_LOD1", sheet(1));
    made.scene.portals.emplace_back().door = 3;
    EXPECT_EQ(takeNamedLevels(made.scene), 1u);
    EXPECT_EQ(made.scene.objects[made.scene.portals[0].door].name, "Door_LOD1");
}

TEST(SceneLevels, JoinedLevelsLieInTheObjectsSpaceAndAreMeasured) {
    SceneMaker made;
    made.add("Sheet_LOD0", sheet(16));
    made.add("Sheet_LOD1", sheet(4), {0, 0, 0.25});  // a quarter off the plane
    made.add("Sheet_LOD2", sheet(1), {0, 0, -0.5});
    made.add("Sheet_LOD3", sheet(1), {0, 0, 0.1});  // nearer than the one before, with as many triangles: of no use
    ASSERT_EQ(takeNamedLevels(made.scene), 3u);
    joinLevels(made.scene);
    EXPECT_TRUE(made.scene.levels.empty());
    Mesh& mesh = made.scene.meshes[made.scene.objects[0].mesh];
    ASSERT_EQ(mesh.lods.size(), 3u);
    addMeshLods(mesh);
    ASSERT_EQ(mesh.lods.size(), 2u);
    EXPECT_GE(mesh.lods[0].error, 0.25);
    EXPECT_LE(mesh.lods[0].error, 0.27);
    EXPECT_GE(mesh.lods[1].error, 0.5);
    EXPECT_LE(mesh.lods[1].error, 0.53);
    EXPECT_EQ(mesh.bounds.min.z, -0.5) << "bounds hold all levels";
    const std::vector<LodLevel> levels = lodLevels(mesh);
    ASSERT_EQ(levels.size(), 3u);
    EXPECT_EQ(levels[0].triangles, 512u);
    EXPECT_EQ(levels[0].vertices, 289u);
    EXPECT_EQ(levels[1].triangles, 32u);
    EXPECT_EQ(levels[1].vertices, 25u);
    EXPECT_EQ(levels[2].vertices, 4u);
}

TEST(SceneLevels, ObjectsShareJoinedMeshesAndMirrorsTurnWindings) {
    SceneMaker made;
    made.add("a", sheet(8));
    made.add("b", sheet(8));
    made.scene.objects[1].mesh = 0;
    made.scene.meshes.push_back(sheet(1));
    glm::dmat4 mirror(1.0);
    mirror[0][0] = -1;
    mirror[3][0] = 1;
    for (const uint32_t object : {0u, 1u}) made.scene.levels.push_back({object, 2, mirror});
    joinLevels(made.scene);
    EXPECT_EQ(made.scene.objects[0].mesh, made.scene.objects[1].mesh);
    const Mesh& mesh = made.scene.meshes[made.scene.objects[0].mesh];
    ASSERT_EQ(mesh.lods.size(), 1u);
    const auto normalOf = [&](const std::vector<uint32_t>& indices) {
        const glm::dvec3 a = mesh.positions[indices[0]], b = mesh.positions[indices[1]], c = mesh.positions[indices[2]];
        return glm::cross(b - a, c - a);
    };
    EXPECT_GT(normalOf(mesh.indices).z * normalOf(mesh.lods[0].indices).z, 0.0);
}

TEST(MeshLods, AreMadeWhereThereAreNone) {
    TestMesh ball;
    constexpr uint32_t kAround = 48, kRings = 24;
    for (uint32_t ring = 0; ring <= kRings; ++ring)
        for (uint32_t k = 0; k < kAround; ++k) {
            const double theta = M_PI * ring / kRings, phi = 2 * M_PI * k / kAround;
            ball.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                        std::sin(theta) * std::sin(phi));
        }
    ball.addGrid(kAround, kRings + 1, true);
    Mesh mesh = meshOf(ball);
    addMeshLods(mesh);
    ASSERT_GE(mesh.lods.size(), 3u);
    size_t triangles = mesh.triangles();
    double error = 0;
    for (const MeshLod& lod : mesh.lods) {
        EXPECT_LT(lod.indices.size() / 3, triangles);
        EXPECT_GT(lod.error, error);
        triangles = lod.indices.size() / 3;
        error = lod.error;
        ASSERT_EQ(lod.primitives.size(), 1u);
        EXPECT_EQ(lod.primitives[0].triangle_count, triangles);
        for (const uint32_t index : lod.indices) ASSERT_LT(index, mesh.positions.size());
    }
    Mesh small = meshOf(boxMesh());
    addMeshLods(small);
    EXPECT_TRUE(small.lods.empty());
    Mesh moving = meshOf(ball);
    moving.deforms = true;
    addMeshLods(moving);
    EXPECT_TRUE(moving.lods.empty());
}

TEST(MeshLods, TheWorldDrawsThemFromAfar) {
    SceneMaker made;
    for (int i = 0; i < 6; ++i) made.add("sheet", sheet(16), {0, 0, -4.0 * std::pow(4.0, i)});
    for (SceneObject& object : made.scene.objects) object.mesh = 0;
    Mesh& mesh = made.scene.meshes[0];
    mesh.lods.resize(1);
    mesh.lods[0].indices = {0, 16, 17 * 16};
    mesh.lods[0].error = 0.8;
    QuerySettings settings;
    settings.lod_error = 4;
    settings.stages = stageBit(Stage::kFrustum) | stageBit(Stage::kLod);
    LoadedWorld loaded = loadWorld(made.scene, {}, loadSettings(settings));
    Query query;
    const VisibleSet set = query.visible(loaded.world.commit(), viewAt({0.5, 0.5, 0}, {0.5, 0.5, -1}), settings);
    ASSERT_EQ(set.objects.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        const double pixels =
            0.8 * 45 / std::tan(glm::radians(30.0)) / (4.0 * std::pow(4.0, double(set.objects[i].key)));
        EXPECT_EQ(set.lods[i].level, pixels <= 4 ? 1 : 0) << set.objects[i].key;
    }
    LoadedWorld plain = loadWorld(made.scene);
    EXPECT_TRUE(query.visible(plain.world.commit(), viewAt({0.5, 0.5, 0}, {0.5, 0.5, -1}), settings).lods.empty());
}

}  // namespace
}  // namespace sightline::test
