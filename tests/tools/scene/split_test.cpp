// Pieces are the same triangles with the same materials in the same places, each once.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/split.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/solids.h"
#include "tests/support/drawn_triangles.h"

namespace sightline {
using namespace tools;
namespace {

using Corner = std::array<double, 3>;
/// What holds of every scene: tables that fit together, boxes that hold their meshes, keys in order.
void expectWhole(const Scene& scene) {
    std::set<uint32_t> used;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        EXPECT_EQ(scene.objects[i].key, i);
        ASSERT_LT(scene.objects[i].mesh, scene.meshes.size());
        used.insert(scene.objects[i].mesh);
        const uint32_t node = scene.objects[i].node;
        EXPECT_TRUE(node == SceneNode::kNone || node < scene.nodes.size());
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
            const glm::dvec3 d(p);
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(d, mesh.bounds.min)) &&
                        glm::all(glm::lessThanEqual(d, mesh.bounds.max)));
        }
    }
}

/// Two cubes apart and a third that shares a corner with the second; two materials.
Scene threeCubes() {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].name = "brick";
    city::MeshBuilder mesh;
    city::addBox(mesh, 0, {0, 0, 0}, {1, 1, 1});
    city::addBox(mesh, 1, {2, 0, 0}, {3, 1, 1});
    city::addBox(mesh, 0, {3, 1, 1}, {4, 2, 2});
    scene.meshes.push_back(mesh.finish("cubes"));
    scene.nodes.push_back({"group", SceneNode::kNone});
    SceneObject& object = scene.objects.emplace_back();
    object.name = "cubes";
    object.node = 0;
    object.key = 7;
    return scene;
}

std::vector<std::string> pathsOf(const Scene& scene) {
    std::vector<std::string> paths;
    for (const SceneObject& object : scene.objects) paths.push_back(objectPath(scene, object));
    return paths;
}

TEST(Split, IsReadOrRefused) {
    EXPECT_EQ(readSplit("parts")->along, Split::Along::kParts);
    EXPECT_EQ(readSplit("materials")->along, Split::Along::kMaterials);
    EXPECT_EQ(readSplit("grid:1024")->cubes, 1024u);
    for (const char* wrong : {"", "part", "grid", "grid:", "grid:0", "grid:1025", "grid:-1", "grid:4x", "grid: 4"}) {
        const Result<Split> read = readSplit(wrong);
        ASSERT_FALSE(read.ok()) << wrong;
        EXPECT_EQ(read.error().kind, Error::Kind::kUsage);
    }
}

TEST(Split, KeepsEveryTriangleOnce) {
    const Scene cubes = threeCubes(), building = makeBuilding(1, 1), city = makeCity(2, 60);
    for (const Scene* scene : {&cubes, &building, &city})
        for (const char* how : {"parts", "materials", "grid:1", "grid:3", "grid:40"}) {
            const Scene split = splitScene(*scene, *readSplit(how));
            EXPECT_EQ(test::trianglesDrawn(split), test::trianglesDrawn(*scene)) << scene->name << ", " << how;
            EXPECT_GE(split.objects.size(), scene->objects.size());
            EXPECT_EQ(split.cells.size(), scene->cells.size());
            expectWhole(split);
        }
    EXPECT_EQ(splitScene(building, {}).objects.size(), building.objects.size());
}

TEST(Split, PartsShareNoCorner) {
    const Scene split = splitScene(threeCubes(), *readSplit("parts"));
    EXPECT_EQ(pathsOf(split), (std::vector<std::string>{"group/cubes/part 0", "group/cubes/part 1"}));
    EXPECT_EQ(split.meshes[split.objects[1].mesh].triangles(), 24u);
    const Scene city = splitScene(makeCity(2, 60), *readSplit("parts"));
    for (const Mesh& mesh : city.meshes) {
        // Flood from the first triangle over shared positions: all of a part is reached.
        std::map<Corner, std::vector<size_t>> at;
        const auto corner = [&](size_t k) {
            const glm::vec3& p = mesh.positions[mesh.indices[k]];
            return Corner{p.x, p.y, p.z};
        };
        for (size_t k = 0; k < mesh.indices.size(); ++k) at[corner(k)].push_back(k / 3);
        std::vector<size_t> queue = {0};
        std::set<size_t> reached = {0};
        for (size_t i = 0; i < queue.size(); ++i)
            for (size_t k = 3 * queue[i]; k < 3 * queue[i] + 3; ++k)
                for (const size_t next : at[corner(k)])
                    if (reached.insert(next).second) queue.push_back(next);
        EXPECT_EQ(reached.size(), mesh.triangles()) << mesh.name;
    }
}

TEST(Split, MaterialsAndCubesHaveTheirNames) {
    EXPECT_EQ(pathsOf(splitScene(threeCubes(), *readSplit("materials"))),
              (std::vector<std::string>{"group/cubes/material 0", "group/cubes/brick"}));
    const Scene grid = splitScene(threeCubes(), *readSplit("grid:2"));
    EXPECT_EQ(pathsOf(grid), (std::vector<std::string>{"group/cubes/cube 0 0 0", "group/cubes/cube 1 0 0",
                                                       "group/cubes/cube 1 0 1", "group/cubes/cube 1 1 0"}));
    for (const SceneObject& object : grid.objects)
        EXPECT_LE(grid.meshes[object.mesh].bounds.size().x, 2 + 1) << "a cube's side and a triangle's";
}

TEST(Split, InstancesShareTheirPieces) {
    Scene scene = threeCubes();
    for (int i = 0; i < 3; ++i) {
        scene.objects.push_back(scene.objects[0]);
        scene.objects.back().transform[3].y = 10 * i + 10;
    }
    const Scene split = splitScene(scene, *readSplit("parts"));
    EXPECT_EQ(split.objects.size(), 8u);
    EXPECT_EQ(split.meshes.size(), 2u);
    EXPECT_EQ(test::trianglesDrawn(split), test::trianglesDrawn(scene));
}

TEST(Split, LeavesWholeWhatMoves) {
    Scene scene = threeCubes();
    scene.meshes[0].deforms = true;
    EXPECT_EQ(splitScene(scene, *readSplit("parts")).objects.size(), 1u);
    scene = threeCubes();
    scene.objects.insert(scene.objects.begin(), scene.objects[0]);
    scene.portals.resize(1);
    scene.portals[0].door = 1;
    const Scene split = splitScene(scene, *readSplit("parts"));
    ASSERT_EQ(split.objects.size(), 3u);
    EXPECT_EQ(split.portals[0].door, 2u) << "the door follows the pieces of what is before it";
    EXPECT_EQ(split.meshes[split.objects[2].mesh].triangles(), 36u);
    EXPECT_EQ(splitScene(makeBuilding(1, 1), *readSplit("grid:4")).portals.size(), makeBuilding(1, 1).portals.size());
}

TEST(Split, FilesBeginWhereTheirPiecesBegin) {
    Scene scene = threeCubes();
    scene.objects[0].key = 0;
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].key = 5;
    scene.files = {{"a.glb", 0}, {"b.glb", 5}};
    const Scene split = splitScene(scene, *readSplit("parts"));
    EXPECT_EQ(split.files[0].first_key, 0u);
    EXPECT_EQ(split.files[1].first_key, 2u);
}

/// A triangle of a mesh, by its corners there.
std::array<Corner, 3> cornersAt(const Mesh& mesh, uint32_t triangle) {
    std::array<Corner, 3> out;
    for (uint32_t k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions[mesh.indices[3 * triangle + k]];
        out[k] = {p.x, p.y, p.z};
    }
    return out;
}

TEST(Split, TellsWhereItsPiecesComeFrom) {
    const Scene city = makeCity(3, 40);
    const CutScene cut = cutScene(city, *readSplit("grid:3"));
    ASSERT_EQ(cut.object_of.size(), cut.scene.objects.size());
    ASSERT_EQ(cut.keys.size(), city.objects.size());
    for (size_t i = 0; i < cut.object_of.size(); ++i) {
        const SceneObject& object = cut.scene.objects[i];
        const Mesh &piece = cut.scene.meshes[object.mesh], &whole = city.meshes[city.objects[cut.object_of[i]].mesh];
        const std::vector<uint32_t>& from = cut.triangles_of[object.mesh];
        EXPECT_EQ(object.transform, city.objects[cut.object_of[i]].transform);
        ASSERT_EQ(from.empty() ? whole.triangles() : from.size(), piece.triangles());
        for (uint32_t t = 0; t < piece.triangles(); ++t)
            ASSERT_EQ(cornersAt(piece, t), cornersAt(whole, from.empty() ? t : from[t]));
    }
}

TEST(Split, LeavesOutWhatNoObjectNeeds) {
    Scene scene = threeCubes();
    scene.objects.push_back(scene.objects[0]);
    scene.objects.back().transform[3].y = 10;
    // Of the first object all of one cube and half of another, of the second the latter half alone.
    std::vector<uint32_t> first(18), second(6);
    std::iota(first.begin(), first.end(), 0u);
    std::iota(second.begin(), second.end(), 12u);
    CutScene whole = uncut(scene);
    EXPECT_EQ(leaveOut(whole, {first, second}), 12u) << "the mesh is shared: what both can do without goes";
    EXPECT_EQ(whole.scene.objects.size(), 2u);

    CutScene parts = cutScene(scene, *readSplit("parts"));
    const std::vector<std::vector<uint32_t>> in_pieces = inPieces(parts, {first, second});
    EXPECT_EQ(in_pieces[0].size(), 12u);
    EXPECT_EQ(in_pieces[1], (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_TRUE(in_pieces[2].empty());
    EXPECT_EQ(leaveOut(parts, in_pieces), 12u + 6 + 6);
    EXPECT_EQ(parts.scene.objects.size(), 3u) << "an object without triangles goes";
    EXPECT_EQ(parts.object_of, (std::vector<uint32_t>{0, 1, 1}));
    for (size_t i = 0; i < parts.scene.objects.size(); ++i) {
        const SceneObject& object = parts.scene.objects[i];
        for (uint32_t t = 0; t < parts.scene.meshes[object.mesh].triangles(); ++t)
            EXPECT_EQ(cornersAt(parts.scene.meshes[object.mesh], t),
                      cornersAt(scene.meshes[0], parts.triangles_of[object.mesh][t]));
    }
}

TEST(Split, LeavesOutNoDoor) {
    Scene scene = threeCubes();
    scene.portals.resize(1);
    scene.portals[0].door = 0;
    std::vector<uint32_t> all(36);
    std::iota(all.begin(), all.end(), 0u);
    CutScene cut = uncut(scene);
    EXPECT_EQ(leaveOut(cut, {all}), 0u);
    EXPECT_EQ(cut.scene.portals[0].door, 0u);
}

}  // namespace
}  // namespace sightline
