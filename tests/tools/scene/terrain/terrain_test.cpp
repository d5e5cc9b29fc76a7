// A procedural terrain is continuous from chunk to chunk, and what stands on it stands on the ground.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/terrain/terrain.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/terrain/height.h"
#include "sightline/tools/scene/terrain/library.h"
#include "tests/tools/scene/scene_hash.h"

namespace sightline {
using namespace tools;
namespace {

bool isGround(const Scene& scene, const SceneObject& object) {
    return scene.meshes[object.mesh].name.rfind("Chunk ", 0) == 0;
}

bool isWater(const Scene& scene, const SceneObject& object) {
    return scene.meshes[object.mesh].name.rfind("Water ", 0) == 0;
}

TEST(Terrain, IsTheSameOnEveryMachine) {
    EXPECT_EQ(hashOfScene(makeTerrain(1, 130)), 15232209908193916311ull);
    EXPECT_EQ(hashOfScene(makeTerrain(18446744073709551615ull, 300)), 15678917503490713562ull);
    EXPECT_EQ(hashOfScene(makeTerrain(5, 64)), hashOfScene(makeTerrain(5, 64)));
    EXPECT_NE(hashOfScene(makeTerrain(5, 64)), hashOfScene(makeTerrain(6, 64)));
}

TEST(Terrain, ChunksCoverTheSquareAndShareTheirBorders) {
    for (const uint32_t size : {16u, 64u, 65u, 66u, 200u, 257u}) {
        const Scene scene = makeTerrain(3, size);
        std::map<std::pair<float, float>, float> heights;
        uint64_t triangles = 0;
        for (const SceneObject& object : scene.objects) {
            if (!isGround(scene, object)) continue;
            EXPECT_EQ(object.transform, glm::dmat4(1.0));
            const Mesh& mesh = scene.meshes[object.mesh];
            triangles += mesh.triangles();
            for (const glm::vec3& p : mesh.positions) {
                ASSERT_TRUE(std::isfinite(p.y));
                const auto [entry, added] = heights.try_emplace({p.x, p.z}, p.y);
                ASSERT_EQ(entry->second, p.y) << mesh.name << " at " << p.x << ", " << p.z;
            }
        }
        EXPECT_EQ(heights.size(), size_t{size} * size);
        EXPECT_EQ(triangles, uint64_t{2} * (size - 1) * (size - 1));
    }
}

TEST(Terrain, GroundIsASheetThatLooksUp) {
    const Scene scene = makeTerrain(8, 150);
    double area = 0;
    std::map<std::pair<std::pair<float, float>, std::pair<float, float>>, int> edges;
    for (const SceneObject& object : scene.objects) {
        if (!isGround(scene, object)) continue;
        const Mesh& mesh = scene.meshes[object.mesh];
        uint32_t covered = 0;
        for (const Primitive& primitive : mesh.primitives) {
            EXPECT_EQ(primitive.first_triangle, covered);
            covered += primitive.triangle_count;
        }
        EXPECT_EQ(covered, mesh.triangles());
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const auto corner = [&](size_t k) { return mesh.positions[mesh.indices[i + k % 3]]; };
            const glm::dvec3 a(corner(0)), b(corner(1)), c(corner(2));
            const double up = 0.5 * glm::cross(b - a, c - a).y;
            ASSERT_EQ(up, 2.0) << mesh.name;  // half a square of 2 m: no triangle is degenerate
            area += up;
            for (size_t k = 0; k < 3; ++k) ++edges[{{corner(k).x, corner(k).z}, {corner(k + 1).x, corner(k + 1).z}}];
        }
    }
    EXPECT_EQ(area, 4.0 * 149 * 149);
    size_t rim = 0;
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        rim += edges.count({edge.second, edge.first}) == 0;
    }
    EXPECT_EQ(rim, 4u * 149);
}

TEST(Terrain, LargerTerrainHasTheSmallerGround) {
    const terrain::HeightField small(77, 64), large(77, 300);
    for (uint32_t j = 0; j < 64; ++j)
        for (uint32_t i = 0; i < 64; ++i) ASSERT_EQ(small.position(i, j), large.position(i + 118, j + 118));
}

TEST(Terrain, HeightsAreContinuousAndVaried) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        const terrain::HeightField field(seed, 512);
        float lowest = field.at(0, 0), highest = lowest;
        for (uint32_t j = 0; j + 1 < 512; ++j) {
            for (uint32_t i = 0; i + 1 < 512; ++i) {
                const float here = field.at(i, j);
                lowest = std::min(lowest, here);
                highest = std::max(highest, here);
                ASSERT_LT(std::abs(field.at(i + 1, j) - here), 12) << "seed " << seed << ", " << i << ", " << j;
                ASSERT_LT(std::abs(field.at(i, j + 1) - here), 12) << "seed " << seed << ", " << i << ", " << j;
            }
        }
        EXPECT_GT(highest - lowest, 30) << "seed " << seed;
        // The ground between samples lies between them.
        for (double x = -500; x < 500; x += 37.3) {
            const double at = field.ground({x, 0.5 * x});
            EXPECT_GE(at, lowest);
            EXPECT_LE(at, highest);
        }
        EXPECT_EQ(field.ground({field.low(), field.low()}), field.at(0, 0));
        EXPECT_EQ(field.ground({0, 0}), field.at(256, 256));
    }
}

TEST(Terrain, NoiseHasTheSlopeThatItGives) {
    for (double x = -2.95; x < 3; x += 0.31) {
        for (double z = -2.85; z < 3; z += 0.37) {
            constexpr double kStep = 1e-6;
            const terrain::Noise here = terrain::noise(9, {x, z});
            const double right = terrain::noise(9, {x + kStep, z}).value,
                         down = terrain::noise(9, {x, z + kStep}).value;
            EXPECT_NEAR((right - here.value) / kStep, here.slope.x, 1e-4);
            EXPECT_NEAR((down - here.value) / kStep, here.slope.y, 1e-4);
        }
    }
}

TEST(Terrain, EverythingStandsOnTheGround) {
    const Scene scene = makeTerrain(2, 400);
    const terrain::HeightField field(mixSeed(2, 0x74657272ull), 400);
    std::map<uint32_t, int> kinds;
    for (const SceneObject& object : scene.objects) {
        if (object.mesh >= terrain::kItemCount) continue;
        ++kinds[object.mesh];
        const glm::dvec3 foot(object.transform[3]);
        EXPECT_EQ(foot.y, field.ground({foot.x, foot.z})) << object.name;
        EXPECT_GT(foot.y, terrain::kLakeLevel) << object.name;
        EXPECT_GE(std::min(foot.x, foot.z), field.low()) << object.name;
        EXPECT_LE(std::max(foot.x, foot.z), field.high()) << object.name;
        // No corner of a wall hangs over the ground: what is built reaches below it.
        const Box3d& bounds = scene.meshes[object.mesh].bounds;
        EXPECT_LT(bounds.min.y, 0) << object.name;
        if (object.mesh != terrain::kHouse && object.mesh != terrain::kHut) continue;
        for (const double x : {bounds.min.x + 0.5, bounds.max.x - 0.5})
            for (const double z : {bounds.min.z + 0.75, bounds.max.z - 0.75}) {
                const glm::dvec3 corner(object.transform * glm::dvec4(x, bounds.min.y, z, 1));
                EXPECT_LT(corner.y, field.ground({corner.x, corner.z})) << object.name;
            }
    }
    EXPECT_GT(kinds[terrain::kOak] + kinds[terrain::kBirch] + kinds[terrain::kSpruce] + kinds[terrain::kPine], 300);
    EXPECT_GT(kinds[terrain::kBoulder] + kinds[terrain::kSlabRock] + kinds[terrain::kStones], 20);
    EXPECT_GT(kinds[terrain::kHouse] + kinds[terrain::kHut], 1);
    EXPECT_GT(kinds[terrain::kFence], 20);
}

TEST(Terrain, LakesLieOverWhatReachesBelowThem) {
    const Scene scene = makeTerrain(1, 600);
    size_t wet = 0, water = 0;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        if (isGround(scene, object)) wet += mesh.bounds.min.y < terrain::kLakeLevel;
        if (!isWater(scene, object)) continue;
        ++water;
        EXPECT_EQ(mesh.bounds.min.y, terrain::kLakeLevel);
        EXPECT_EQ(mesh.bounds.max.y, terrain::kLakeLevel);
        EXPECT_TRUE(scene.materials[mesh.primitives[0].material].hides());
    }
    EXPECT_GT(wet, 0u);
    EXPECT_EQ(wet, water);
}

TEST(Terrain, StockIsClosed) {
    const Pieces library = terrain::makeLibrary();
    for (const Mesh& mesh : library.meshes) {
        double volume = 0;
        std::map<std::pair<uint32_t, uint32_t>, int> edges;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const uint32_t* const t = &mesh.indices[i];
            const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
            volume += glm::dot(a, glm::cross(b, c)) / 6;
            for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
        }
        EXPECT_GT(volume, 0) << mesh.name;
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            ASSERT_TRUE(back != edges.end() && back->second == count) << mesh.name;
        }
    }
}

TEST(Terrain, NamesItsObjects) {
    const Scene scene = makeTerrain(1, 200);
    bool chunk = false, tree = false;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        EXPECT_EQ(scene.objects[i].key, i);
        const std::string path = objectPath(scene, scene.objects[i]);
        chunk = chunk || path == "Ground/Chunk 3,2";
        tree = tree || path.rfind("Trees/", 0) == 0;
    }
    EXPECT_TRUE(chunk);
    EXPECT_TRUE(tree);
    EXPECT_GE(scene.cameras.size(), 8u);
}

}  // namespace
}  // namespace sightline
