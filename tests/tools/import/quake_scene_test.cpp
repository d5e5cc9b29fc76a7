// Maps as scenes: what hides in each format, where entities stand, curved patches, entities' text.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gltf_check.h"
#include "map_check.h"
#include "mutated.h"
#include "map_files.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/import/scene_file.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

QuakeMapFile parsed(const std::string& bytes) {
    Result<QuakeMapFile> map = parseQuakeBsp(bytesOf(bytes), "test.bsp");
    EXPECT_TRUE(map.ok()) << map.error().message;
    return std::move(*map);
}

const Material& materialOf(const Scene& scene, const SceneObject& object) {
    return scene.materials[scene.meshes[object.mesh].primitives[0].material];
}

TEST(QuakeScene, EachFaceIsAnObject) {
    const MadeMap made;
    for (const QuakeFormat format : kQuakeFormats) {
        const std::string name = quakeFormatName(format);
        const Result<Scene> scene = quakeScene(parsed(mapBytes(format, made)), "test.bsp");
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(sceneFault(*scene), "") << name;
        ASSERT_EQ(scene->objects.size(), 8u) << name;
        for (size_t i = 0; i < 8; ++i) {
            const SceneObject& object = scene->objects[i];
            EXPECT_EQ(object.key, i) << name;
            EXPECT_EQ(object.name, i == 6 ? "*water" : "wall1") << name;
            EXPECT_EQ(objectPath(*scene, object), i == 7   ? "func_door *1/wall1"
                                                  : i == 6 ? "worldspawn/*water"
                                                           : "worldspawn/wall1");
            const Material& material = materialOf(*scene, object);
            EXPECT_EQ(material.hides(), i < 6) << name << " face " << i;
            EXPECT_EQ(material.alpha_mode, i == 6 ? AlphaMode::kBlend : AlphaMode::kOpaque) << name;
            EXPECT_EQ(material.double_sided, i == 6) << name;
            EXPECT_EQ(material.transmissive, i == 7) << name;
        }
        EXPECT_EQ(glm::dvec3(scene->objects[7].transform[3]), glm::dvec3(8, 0, 0)) << name;
        const Box3d bounds = worldBounds(*scene);
        EXPECT_LT(glm::distance(bounds.min, glm::dvec3(-64, 0, -32)), 1e-9) << name;
        EXPECT_LT(glm::distance(bounds.max, glm::dvec3(64, 48, 32)), 1e-9) << name;
        // The walls look inward.
        for (size_t i = 0; i < 6; ++i) {
            const Mesh& mesh = scene->meshes[scene->objects[i].mesh];
            const glm::vec3 a = mesh.positions[mesh.indices[0]], b = mesh.positions[mesh.indices[1]],
                            c = mesh.positions[mesh.indices[2]];
            EXPECT_GT(glm::dot(glm::cross(b - a, c - a), glm::vec3(0, 24, 0) - a), 0) << name << " face " << i;
        }
    }
}

/// Quake and Half-Life: names decide, the flag of what has no light, and what the tree has behind the face.
TEST(QuakeScene, WhatMayNotHideDoesNot) {
    const auto surfaceOf = [](const std::string& bytes, size_t face) {
        const QuakeMapFile map = parsed(bytes);
        return quakeSurface(map, map.faces[face]);
    };
    for (const QuakeFormat format : {QuakeFormat::kQuake, QuakeFormat::kBsp2, QuakeFormat::kHalfLife}) {
        for (const char* name : {"*lava", "{grate", "sky1", "SKY_blue", "trigger", "Clip", "skip", "hint", "hintskip",
                                 "!water", "AAAtrigger", "origin", "null", "nodraw"}) {
            MadeMap made;
            made.textures[0] = name;
            EXPECT_EQ(surfaceOf(mapBytes(format, made), 0), QuakeSurface::kSeeThrough) << name;
        }
        for (const char* name : {"", "wall", "+0button", "a*b", "tech{", "mysky"}) {
            MadeMap made;
            made.textures[0] = name;
            EXPECT_EQ(surfaceOf(mapBytes(format, made), 0), QuakeSurface::kSolid) << name;
            EXPECT_EQ(surfaceOf(mapBytes(format, made), 7), QuakeSurface::kMovable) << name;
        }
        MadeMap nameless;  // a sheet of water whose texture was left out is known by what lies behind it
        nameless.textures.assign(4, "");
        EXPECT_EQ(surfaceOf(mapBytes(format, nameless), 0), QuakeSurface::kSolid);
        EXPECT_EQ(surfaceOf(mapBytes(format, nameless), 6), QuakeSurface::kSeeThrough);
        const std::string bytes = mapBytes(format, nameless);
        EXPECT_EQ(surfaceOf(patched(bytes, lumpOf(bytes, 6).offset + 36, 1), 0), QuakeSurface::kSeeThrough);
    }
    MadeMap wet;
    wet.textures[0] = "water4";
    EXPECT_EQ(surfaceOf(mapBytes(QuakeFormat::kHalfLife, wet), 0), QuakeSurface::kSeeThrough);
    EXPECT_EQ(surfaceOf(mapBytes(QuakeFormat::kQuake, wet), 0), QuakeSurface::kSolid);

    const std::string second = mapBytes(QuakeFormat::kQuake2, {});
    const auto secondBy = [&](int32_t flags, size_t face) {
        return surfaceOf(patched(second, lumpOf(second, 5).offset + 32, flags), face);
    };
    for (const int32_t flags : {4, 8, 0x10, 0x20, 0x2000000, 4 | 0x80})
        EXPECT_EQ(secondBy(flags, 0), QuakeSurface::kSeeThrough) << flags;
    for (const int32_t flags : {0x80, 0x100, 0x200}) EXPECT_EQ(secondBy(flags, 0), QuakeSurface::kNotDrawn) << flags;
    for (const int32_t flags : {0, 1, 2, 0x40}) {
        EXPECT_EQ(secondBy(flags, 0), QuakeSurface::kSolid) << flags;
        EXPECT_EQ(secondBy(flags, 7), QuakeSurface::kMovable) << flags;
    }

    const std::string third = mapBytes(QuakeFormat::kQuake3, {});
    const auto thirdBy = [&](int32_t flags, int32_t contents, size_t face) {
        const size_t shader = lumpOf(third, 1).offset;
        return surfaceOf(patched(patched(third, shader + 64, flags), shader + 68, contents), face);
    };
    EXPECT_EQ(thirdBy(0, 1, 0), QuakeSurface::kSolid);
    EXPECT_EQ(thirdBy(0, 1, 7), QuakeSurface::kMovable);
    for (const int32_t flags : {0x80, 0x100, 0x200}) EXPECT_EQ(thirdBy(flags, 1, 0), QuakeSurface::kNotDrawn) << flags;
    for (const int32_t flags : {4, 4 | 0x80, 0x4000})
        EXPECT_EQ(thirdBy(flags, 1, 0), QuakeSurface::kSeeThrough) << flags;
    for (const int32_t contents : {0, 1 | 8, 1 | 16, 1 | 32, 1 | 64, 1 | 0x20000000})
        EXPECT_EQ(thirdBy(0, contents, 0), QuakeSurface::kSeeThrough) << contents;
    // Face 0 as a mesh, whose shader may be anything.
    EXPECT_EQ(surfaceOf(patched(third, lumpOf(third, 13).offset + 8, 3), 0), QuakeSurface::kSeeThrough);
}

TEST(QuakeScene, PlayersBeginWithOpenEyes) {
    MadeMap made;
    made.entities +=
        "{\n\"classname\" \"info_player_start\"\n\"origin\" \"-10 20 24\"\n\"angle\" \"90\"\n}\n"
        "{ \"classname\" \"info_intermission\" // where one looks from\n \"origin\" \"1 2 3\" }";
    const Result<Scene> scene = quakeScene(parsed(mapBytes(QuakeFormat::kQuake, made)), "test.bsp");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_EQ(scene->cameras.size(), 2u);
    const SceneCamera& camera = scene->cameras[0];
    EXPECT_EQ(glm::dvec3(camera.transform[3]), glm::dvec3(-10, 46, -20));
    EXPECT_LT(glm::distance(-glm::dvec3(camera.transform[2]), glm::dvec3(0, 0, -1)), 1e-12);  // along the file's y
    EXPECT_GT(glm::determinant(glm::dmat3(camera.transform)), 0.99);
    EXPECT_EQ(scene->cameras[1].name, "info_intermission");
    EXPECT_EQ(scene->walk_speed, 320);
}

TEST(QuakeScene, SaysWhatIsWrongWithItsEntities) {
    const auto expectLine = [](const std::string& entities, const std::string& line) {
        MadeMap made;
        made.entities = entities;
        const Result<Scene> scene = quakeScene(parsed(mapBytes(QuakeFormat::kQuake, made)), "test.bsp");
        ASSERT_FALSE(scene.ok()) << entities;
        EXPECT_EQ(scene.error().message, "test.bsp: " + line);
    };
    expectLine("x", "entities: line 1: \"x\" where '{' was expected");
    expectLine("{\n\"a\" \"b\"\n", "entities: line 3: the file ends where a key, a brush or '}' was expected");
    expectLine("{\n\"a\" \"b\n", "entities: line 2: a quote is not closed on its line");
    expectLine("{\n\"a\"\n}", "entities: line 3: \"}\" where a value in quotes was expected");
    expectLine("{ \"model\" \"*1\" \"origin\" \"1 2\" }", "entity 0: its origin '1 2' is no point");
    expectLine("{ \"model\" \"*1\" \"origin\" \"1 2 nan\" }", "entity 0: its origin '1 2 nan' is no point");
    std::string many;
    for (int i = 0; i < 33; ++i) many += "{ \"model\" \"*1\" }";
    expectLine(many, "entity 32: its model is shown too often");
}

/// De Casteljau's way, by repeated means, at the parameters of the grid.
TEST(QuakePatch, PointsAreOnTheSurfaceAndItsBoundsHoldIt) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        const auto width = static_cast<uint32_t>(3 + 2 * random.below(4)),
                   height = static_cast<uint32_t>(3 + 2 * random.below(4));
        std::vector<glm::vec3> control(size_t(width) * height);
        for (glm::vec3& point : control)
            for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(random.uniform(-100, 100));
        Mesh mesh;
        tessellatePatch(control, width, height, mesh);
        const uint32_t columns = (width - 1) * 2 + 1, rows = (height - 1) * 2 + 1;
        ASSERT_EQ(mesh.positions.size(), size_t(columns) * rows);
        EXPECT_EQ(mesh.triangles(), size_t(columns - 1) * (rows - 1) * 2);
        EXPECT_TRUE(mesh.deforms);
        const auto curve = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double t) {
            return glm::mix(glm::mix(a, b, t), glm::mix(b, c, t), t);
        };
        for (uint32_t row = 0; row < rows; ++row)
            for (uint32_t column = 0; column < columns; ++column) {
                const uint32_t x = std::min(column / 4, (width - 3) / 2) * 2,
                               y = std::min(row / 4, (height - 3) / 2) * 2;
                glm::dvec3 across[3];
                for (uint32_t i = 0; i < 3; ++i) {
                    const glm::vec3* line = &control[size_t(y + i) * width + x];
                    across[i] = curve(line[0], line[1], line[2], (column - 2 * x) / 4.0);
                }
                const glm::dvec3 wanted = curve(across[0], across[1], across[2], (row - 2 * y) / 4.0);
                EXPECT_LT(glm::distance(glm::dvec3(mesh.positions[size_t(row) * columns + column]), wanted), 1e-4)
                    << seed;
            }
        for (const glm::vec3& point : control)
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(point[axis], mesh.bounds.min[axis]);
                EXPECT_LE(point[axis], mesh.bounds.max[axis]);
            }
    }
}

TEST(QuakePatch, APatchOfAMapDeforms) {
    MadeMap made;
    made.faces[3].points.assign(9, glm::vec3(1, 2, 3));
    made.faces[3].points[4].z = 40;
    const std::string bytes = mapBytes(QuakeFormat::kQuake3, made);
    const size_t face = lumpOf(bytes, 13).offset + 3 * 104;
    const std::string patch = patched(patched(patched(bytes, face + 8, 2), face + 96, 3), face + 100, 3);
    const Result<Scene> scene = quakeScene(parsed(patch), "test.bsp");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(sceneFault(*scene), "");
    const Mesh& mesh = scene->meshes[scene->objects[3].mesh];
    EXPECT_TRUE(mesh.deforms);
    EXPECT_EQ(mesh.triangles(), 32u);
    EXPECT_EQ(mesh.bounds.max.y, 40);
    EXPECT_FALSE(materialOf(*scene, scene->objects[3]).hides());
    const Result<QuakeMapFile> odd = parseQuakeBsp(bytesOf(patched(patch, face + 96, 4)), "test.bsp");
    ASSERT_FALSE(odd.ok());
    EXPECT_EQ(odd.error().message, "test.bsp: faces[3]: a patch of 4 x 3 control points that has 9");
}

TEST(QuakeSceneOfRealMaps, MostOfTheWorldHides) {
    for (const char* name : {"lq_e1m5", "lq_e2m2", "lq_e4m1", "lqdm3"}) {
        const std::string file = fmt::format("{}/maps/{}.vis.bsp", SIGHTLINE_SHARED_DIR, name);
        if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared maps are not there";
        const Result<Scene> scene = loadSceneFile(file);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        EXPECT_EQ(sceneFault(*scene), "") << name;
        size_t hiding = 0, world = 0;
        for (const SceneObject& object : scene->objects) {
            world += object.node == 0;
            hiding += materialOf(*scene, object).hides();
            ASSERT_TRUE(object.node == 0 || !materialOf(*scene, object).hides()) << object.key;
        }
        EXPECT_GT(hiding, world / 10 * 9) << name;
        EXPECT_LT(hiding, world) << name;
        EXPECT_FALSE(scene->cameras.empty()) << name;
    }
}

/// quakeSurface() looks behind the middles of triangles. At random points of what it lets hide, nothing but what is solid
/// lies behind, up to the edges of wedges: no face has liquid or sky behind two of its points.
TEST(QuakeSceneOfRealMaps, BehindWhatHidesIsSolid) {
    for (const char* name : {"lq_e1m5", "lq_e2m2", "lq_e4m1", "lqdm3"}) {
        const auto map = sharedMap(name);
        if (!map) GTEST_SKIP() << "no maps beside the repository";
        Random random(1);
        uint64_t points = 0, solid = 0;
        for (const QuakeFace& face : map->faces) {
            if (quakeSurface(*map, face) != QuakeSurface::kSolid) continue;
            const glm::vec3* const corner = map->points.data() + face.first_point;
            uint64_t open = 0;  // liquid or sky
            glm::dvec3 area(0);
            for (uint32_t i = 1; i + 1 < face.point_count; ++i)
                area += glm::cross(glm::dvec3(corner[i] - corner[0]), glm::dvec3(corner[i + 1] - corner[0]));
            for (uint32_t i = 1; i + 1 < face.point_count; ++i) {
                const glm::dvec3 a = corner[0], u = glm::dvec3(corner[i]) - a, v = glm::dvec3(corner[i + 1]) - a;
                for (int k = 0; k < 4; ++k, ++points) {
                    const double s = random.uniform(), t = random.uniform();
                    const glm::dvec3 point = s + t > 1 ? a + (1 - s) * u + (1 - t) * v : a + s * u + t * v;
                    const uint32_t leaf = leafAt(map->tree, point - 0.03 * glm::normalize(area));
                    const LeafContents contents = map->tree.contents[leaf];
                    solid += contents == LeafContents::kSolid;
                    open += contents == LeafContents::kLiquid || contents == LeafContents::kSky;
                }
            }
            EXPECT_LE(open, 1u) << name << " face " << &face - map->faces.data();
        }
        EXPECT_GT(points, 60000u) << name;
        EXPECT_GT(double(solid), 0.998 * double(points)) << name;
    }
}

}  // namespace
}  // namespace sightline
