// Compiled maps: the same map in six formats is read as the same, and what does not hold is refused.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "map_check.h"
#include "mutated.h"
#include "map_files.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/text_file.h"
#include "tests/support/corpus.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

Result<QuakeMapFile> parseBsp(const std::string& bytes) { return parseQuakeBsp(bytesOf(bytes), "test.bsp"); }

/// Twice the area of an outline, as a vector towards its front.
glm::dvec3 areaOf(std::span<const glm::vec3> outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += glm::cross(glm::dvec3(outline[i] - outline[0]), glm::dvec3(outline[i + 1] - outline[0]));
    return area;
}

TEST(QuakeBsp, SixFormatsSayTheSame) {
    const MadeMap made;
    for (const QuakeFormat format : kQuakeFormats) {
        const std::string name = quakeFormatName(format);
        const Result<QuakeMapFile> map = parseBsp(mapBytes(format, made));
        ASSERT_TRUE(map.ok()) << name << ": " << map.error().message;
        EXPECT_EQ(map->format, format);
        EXPECT_EQ(mapFault(*map), "") << name;
        const bool third = format == QuakeFormat::kQuake3;
        const LeafContents wet = third ? LeafContents::kEmpty : LeafContents::kLiquid;
        EXPECT_EQ(map->tree.contents, (std::vector{LeafContents::kSolid, LeafContents::kEmpty, wet})) << name;
        EXPECT_EQ(map->tree.nodes.size(), 7u) << name;
        EXPECT_EQ(map->tree.bounds.min, glm::dvec3(-64, 0, -32)) << name;
        EXPECT_EQ(map->tree.bounds.max, glm::dvec3(64, 48, 32)) << name;
        EXPECT_EQ(leafAt(map->tree, {-1, 24, 0}), 1u) << name;
        EXPECT_EQ(leafAt(map->tree, {1, 24, 0}), 2u) << name;
        for (const glm::dvec3& out : {glm::dvec3(65, 24, 0), glm::dvec3(0, 24, 33), glm::dvec3(0, -1, 0)})
            EXPECT_EQ(leafAt(map->tree, out), 0u) << name;
        EXPECT_EQ(map->clusters, 2u) << name;
        EXPECT_EQ(map->cluster_of_leaf, (std::vector<uint32_t>{QuakeMapFile::kNoCluster, 0, 1})) << name;
        EXPECT_EQ(map->entities, made.entities) << name;
        ASSERT_EQ(map->faces.size(), made.faces.size()) << name;
        for (size_t i = 0; i < made.faces.size(); ++i) {
            const QuakeFace& face = map->faces[i];
            EXPECT_EQ(face.kind, QuakeFace::Kind::kPolygon) << name;
            EXPECT_EQ(face.index_count, third ? 3 * (face.point_count - 2) : 0) << name;
            EXPECT_EQ(face.model, i + 1 == made.faces.size() ? 1u : 0u) << name;
            EXPECT_EQ(map->textures[face.texture].name, made.textures[static_cast<size_t>(made.faces[i].texture)]);
            std::vector<glm::vec3> wanted;
            for (const glm::vec3& p : made.faces[i].points) wanted.emplace_back(p.x, p.z, -p.y);
            const auto points = std::span(map->points).subspan(face.first_point, face.point_count);
            EXPECT_EQ(std::vector(points.begin(), points.end()), wanted) << name << " face " << i;
            for (uint32_t k = 0; k < face.index_count; k += 3)
                EXPECT_GT(glm::dot(areaOf(wanted), areaOf(std::vector{wanted[map->indices[face.first_index + k]],
                                                                      wanted[map->indices[face.first_index + k + 1]],
                                                                      wanted[map->indices[face.first_index + k + 2]]})),
                          0)
                    << name << " face " << i;
        }
        EXPECT_EQ(map->faces_of_leaf[1].count, made.faces.size()) << name;
        EXPECT_EQ(map->faces_of_leaf[2].first, made.faces.size() - 2) << name;
        EXPECT_EQ(map->leaf_faces.size(), made.faces.size()) << name;
    }
}

TEST(QuakeBsp, BlueShiftHasTwoLumpsTheOtherWay) {
    const std::string bytes = mapBytes(QuakeFormat::kHalfLife, {});
    std::string shifted = bytes;
    shifted.replace(4, 8, bytes, 12, 8).replace(12, 8, bytes, 4, 8);
    const Result<QuakeMapFile> map = parseBsp(shifted), plain = parseBsp(bytes);
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->entities, plain->entities);
    EXPECT_EQ(map->tree.nodes.size(), plain->tree.nodes.size());
}

TEST(QuakeBsp, EachCutOfItIsRefused) {
    for (const QuakeFormat format : kQuakeFormats) {
        MadeMap made;
        madeVisibility(format, true, made);
        const std::string whole = mapBytes(format, made);
        size_t end = 0;  // of the last lump that holds anything
        for (int i = 0; i < (format == QuakeFormat::kQuake2 ? 19 : 15); ++i)
            if (const MadeLump lump = lumpOf(whole, i); lump.size > 0)
                end = std::max<size_t>(end, lump.offset + lump.size);
        for (size_t size = 0; size < end; ++size) {
            const Result<QuakeMapFile> map = parseBsp(whole.substr(0, size));
            ASSERT_FALSE(map.ok()) << quakeFormatName(format) << " " << size;
            EXPECT_EQ(lineFault(map.error(), "test.bsp"), "");
        }
    }
}

/// Each spoils one number of the Quake map, by the record that holds it.
TEST(QuakeBsp, SaysInOneLineWhatDoesNotHold) {
    const std::string whole = mapBytes(QuakeFormat::kQuake, {});
    const auto expectLine = [&](const std::string& bytes, const std::string& line) {
        const Result<QuakeMapFile> map = parseBsp(bytes);
        ASSERT_FALSE(map.ok()) << line;
        EXPECT_EQ(map.error().message, "test.bsp: " + line);
    };
    const auto in = [&](int lump, size_t record, size_t stride, size_t byte) {
        return lumpOf(whole, lump).offset + record * stride + byte;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expectLine("", "is no compiled map of Quake, Half-Life, Quake 2 or Quake 3");
    expectLine(patched(whole, 0, int32_t(28)), "is no compiled map of Quake, Half-Life, Quake 2 or Quake 3");
    expectLine(patched(patched(whole, 0, 0x50534249), 4, 17), "is a map of another format (IBSP version 17)");
    expectLine(patched(whole, 4 + 8 * 3 + 4, int32_t(13)), "its vertices take 13 bytes, which is no multiple of 12");
    expectLine(patched(whole, 4 + 8 * 10 + 4, int32_t(0)), "has no leaves");
    expectLine(patched(whole, in(14, 0, 64, 52), int32_t(3)), "models[0]: 3 leaves of the world of 2");
    expectLine(patched(whole, in(5, 2, 24, 0), int32_t(7)), "nodes[2]: planes 7 of 7");
    expectLine(patched(whole, in(5, 2, 24, 0), int32_t(-1)), "nodes[2]: planes 4294967295 of 7");
    expectLine(patched(whole, in(5, 6, 24, 4), int16_t(-4)), "nodes[6]: leaf 3 of 3");
    expectLine(patched(whole, in(5, 6, 24, 4), int16_t(6)), "nodes[6]: hangs in the tree twice");
    expectLine(patched(whole, in(5, 6, 24, 4), int16_t(0)), "nodes[0]: hangs in the tree twice");
    expectLine(patched(whole, in(5, 6, 24, 4), int16_t(-2)), "leaves[1]: is open, and hangs in the tree twice");
    expectLine(patched(whole, in(1, 3, 20, 4), nan), "planes[3]: a number that is not finite or beyond 1e9");
    expectLine(patched(whole, in(1, 3, 20, 12), nan), "planes[3]: a number that is not finite or beyond 1e9");
    expectLine(patched(whole, in(1, 3, 20, 4), 0.0f), "planes[3]: it has no direction");
    expectLine(patched(whole, in(3, 0, 12, 8), nan), "vertices[0]: a number that is not finite or beyond 1e9");
    expectLine(patched(whole, in(3, 0, 12, 8), 2e9f), "vertices[0]: a number that is not finite or beyond 1e9");
    expectLine(patched(whole, in(7, 1, 20, 4), int32_t(-1)), "faces[1]: face edges -1 to 3 of 33");
    expectLine(patched(whole, in(7, 1, 20, 4), int32_t(30)), "faces[1]: face edges 30 to 34 of 33");
    expectLine(patched(whole, in(7, 1, 20, 10), int16_t(4)), "faces[1]: texinfo 4 of 4");
    expectLine(patched(whole, in(6, 1, 40, 32), int32_t(4)), "texinfo[1]: texture 4 of 4");
    expectLine(patched(whole, in(2, 0, 4, 0), int32_t(1 << 30)),
               "its textures are 1073741824, more than their lump has places for");
    expectLine(patched(whole, in(2, 1, 4, 0), int32_t(1000)), "textures[0]: begins at byte 1000 of 180");
    expectLine(patched(whole, in(13, 3, 4, 0), std::numeric_limits<int32_t>::min()),
               "face edges[3]: edges 2147483648 of 22");
    expectLine(patched(whole, in(12, 3, 4, 0), int16_t(-1)), "edges[3]: vertices 65535 of 17");
    expectLine(patched(whole, in(11, 3, 2, 0), int16_t(8)), "leaf faces[3]: face 8 of 8");
    expectLine(patched(whole, in(10, 2, 28, 22), uint16_t(9)), "leaves[2]: faces 6 to 15 of 8");
    expectLine(patched(whole, in(14, 1, 64, 60), int32_t(2)), "models[1]: faces 7 to 9 of 8");
    expectLine(patched(whole, in(14, 1, 64, 56), int32_t(2)), "models[1]: face 2 is model 0's as well");
    expectLine(patched(whole, in(14, 0, 64, 36), int32_t(7)), "models[0]: nodes 7 of 7");
    expectLine(patched(whole, in(14, 0, 64, 4), nan), "models[0]: a number that is not finite or beyond 1e9");
}

TEST(QuakeBsp, TheFacesOfALieTakeNoMemory) {
    // 200 faces, each of which claims all 65535 edges of the list.
    std::string bytes = mapBytes(QuakeFormat::kQuake, {});
    const auto grow = [&](int lump, const std::string& record, size_t count) {
        const auto offset = static_cast<uint32_t>(bytes.size());
        for (size_t i = 0; i < count; ++i) bytes += record;
        bytes = patched(bytes, 4 + 8 * static_cast<size_t>(lump), offset);
        bytes = patched(bytes, 8 + 8 * static_cast<size_t>(lump), static_cast<uint32_t>(bytes.size() - offset));
    };
    grow(13, std::string("\x01\0\0\0", 4), 65535);
    grow(7, std::string("\0\0\0\0\0\0\0\0\xff\xff\0\0\0\0\0\0\0\0\0\0", 20), 200);
    const Result<QuakeMapFile> map = parseBsp(bytes);
    ASSERT_FALSE(map.ok());
    EXPECT_EQ(map.error().message, "test.bsp: faces[2]: it shares its edges with other faces");
}

TEST(QuakeBsp, TreesDeeperThanPromisedAreRefused) {
    // A chain: each node's front is the next one.
    std::string bytes = mapBytes(QuakeFormat::kBsp2, {});
    for (const uint32_t depth : {QuakeMapFile::kDeepest, QuakeMapFile::kDeepest + 1}) {
        std::string nodes;
        for (uint32_t i = 0; i < depth; ++i) {
            std::string node(44, '\0');
            node = patched(node, 4, i + 1 < depth ? static_cast<int32_t>(i + 1) : -2);
            nodes += patched(node, 8, int32_t(-1));
        }
        std::string deep = patched(bytes, 4 + 8 * 5, static_cast<uint32_t>(bytes.size())) + nodes;
        deep = patched(deep, 8 + 8 * 5, static_cast<uint32_t>(nodes.size()));
        EXPECT_EQ(parseBsp(deep).ok(), depth == QuakeMapFile::kDeepest);
    }
}

TEST(QuakeBspOfRealMaps, FacesLookAwayFromWhatIsSolid) {
    struct Map {
        const char* name;
        uint32_t leaves, faces;
    };
    for (const Map& made : {Map{"lq_e1m5", 3911, 19651}, Map{"lq_e2m2", 1927, 8902}, Map{"lq_e4m1", 4469, 15346},
                            Map{"lqdm3", 3148, 11949}}) {
        const auto map = sharedMap(made.name);
        if (!map) GTEST_SKIP() << "no maps beside the repository";
        EXPECT_EQ(mapFault(*map), "");
        EXPECT_EQ(map->clusters, made.leaves);
        EXPECT_EQ(map->models[0].face_count, made.faces);
        // Behind nearly each face of the world is what is solid, or liquid, or sky; before it is none.
        uint32_t before = 0, behind = 0;
        for (const QuakeFace& face : map->faces) {
            if (face.model != 0 || face.kind != QuakeFace::Kind::kPolygon) continue;
            const auto outline = std::span(map->points).subspan(face.first_point, face.point_count);
            glm::dvec3 middle(0);
            for (const glm::vec3& point : outline) middle += glm::dvec3(point) / double(outline.size());
            const glm::dvec3 step = glm::normalize(areaOf(outline)) * 0.05;
            before += map->tree.contents[leafAt(map->tree, middle + step)] == LeafContents::kSolid;
            behind += map->tree.contents[leafAt(map->tree, middle - step)] != LeafContents::kEmpty;
        }
        EXPECT_LT(before, made.faces / 50) << made.name;
        EXPECT_GT(behind, made.faces / 100 * 97) << made.name;
    }
}

TEST(QuakeBspMutation, SurvivesTwentyThousandMutations) {
    std::vector<std::string> samples;
    for (const QuakeFormat format : kQuakeFormats) {
        MadeMap made;
        madeVisibility(format, true, made);
        samples.push_back(mapBytes(format, made));
    }
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        ASSERT_EQ(bspFault(mutated(samples[random.below(samples.size())], random)), "") << "seed " << seed;
    }
}

TEST(QuakeBspMutation, CorpusOfTheFuzzerIsSound) {
    forCorpus("bsp", 6,
              [](const std::string& name, const std::string& bytes) { EXPECT_EQ(bspFault(bytes), "") << name; });
}

}  // namespace
}  // namespace sightline
