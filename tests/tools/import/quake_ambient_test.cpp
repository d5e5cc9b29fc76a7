// Ambient sounds are heard in each leaf that sees a face of their texture, and nothing else of a map changes.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_ambient.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "tests/tools/import/map_files.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

std::vector<unsigned char> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

bool isOfQuake(QuakeFormat format) {
    return format == QuakeFormat::kQuake || format == QuakeFormat::kBsp2 || format == QuakeFormat::kPsb2;
}

size_t leafBytes(QuakeFormat format) {
    return format == QuakeFormat::kBsp2 ? 44 : format == QuakeFormat::kPsb2 ? 32 : 28;
}

/// The four levels of a leaf of a Quake map.
std::string levelsOf(const std::vector<unsigned char>& bytes, QuakeFormat format, size_t leaf) {
    constexpr int kLeaves = 10;
    const std::string text(bytes.begin(), bytes.end());
    const size_t at = lumpOf(text, kLeaves).offset + (leaf + 1) * leafBytes(format) - 4;
    std::string out;
    for (size_t i = 0; i < 4; ++i) out += bytes[at + i] == 255 ? '1' : bytes[at + i] == 0 ? '0' : '?';
    return out;
}

BitMatrix rowsOfTwo(bool open) {
    BitMatrix rows(2, 2);
    for (size_t a = 0; a < 2; ++a)
        for (size_t b = 0; b < 2; ++b)
            if (open || a == b) rows.set(a, b);
    return rows;
}

TEST(QuakeAmbient, IsHeardWhereItIsSeen) {
    for (const QuakeFormat format : kQuakeFormats) {
        SCOPED_TRACE(quakeFormatName(format));
        MadeMap map;
        const auto with = [&](const char* texture, size_t face, bool open) {
            map.textures[1] = texture;
            for (MadeFace& each : map.faces) each.texture = 0;
            map.faces[face].texture = 1;
            madeVisibility(format, open, map);
            return bytesOf(mapBytes(format, map));
        };
        if (!isOfQuake(format)) {
            std::vector<unsigned char> bytes = with("*water", 6, true);
            const std::vector<unsigned char> before = bytes;
            const Result<uint64_t> heard = writeAmbientLevels(bytes, "made.bsp", rowsOfTwo(true));
            ASSERT_TRUE(heard.ok()) << heard.error().message;
            EXPECT_EQ(*heard, 0u);
            EXPECT_EQ(bytes, before);
            continue;
        }
        struct Case {
            const char* texture;
            const char* levels;
            AmbientSounds without;
        };
        for (const Case& each : {Case{"*WATER1", "1000", {.water = false}}, Case{"*04water2", "1000", {.water = false}},
                                 Case{"*slime", "1000", {.slime = false}}, Case{"*lava7", "0001", {.lava = false}},
                                 Case{"Sky4", "0100", {.sky = false}}, Case{"water", "0000", {}}})
            for (size_t face = 0; face < 7; ++face)
                for (const bool open : {false, true}) {
                    SCOPED_TRACE(testing::Message() << each.texture << ", face " << face << ", open " << open);
                    std::vector<unsigned char> bytes = with(each.texture, face, open);
                    const std::vector<unsigned char> before = bytes;
                    const Result<uint64_t> heard = writeAmbientLevels(bytes, "made.bsp", rowsOfTwo(open));
                    ASSERT_TRUE(heard.ok()) << heard.error().message;
                    // By the definition, from the map as it is read.
                    const Result<QuakeMapFile> read = parseQuakeBsp(before, "made.bsp");
                    ASSERT_TRUE(read.ok());
                    uint64_t some = 0;
                    for (size_t leaf = 1; leaf <= 2; ++leaf) {
                        bool seen = false;
                        for (size_t other = 1; other <= 2; ++other) {
                            if (!open && other != leaf) continue;
                            const QuakeLeafFaces& run = read->faces_of_leaf[other];
                            for (uint32_t i = run.first; i < run.first + run.count; ++i)
                                seen |= read->textures[read->faces[read->leaf_faces[i]].texture].name == each.texture;
                        }
                        EXPECT_EQ(levelsOf(bytes, format, leaf), seen ? each.levels : "0000") << leaf;
                        some += seen && std::string(each.levels) != "0000";
                    }
                    EXPECT_EQ(*heard, some);
                    EXPECT_EQ(levelsOf(bytes, format, 0), levelsOf(before, format, 0)) << "the solid leaf";
                    size_t changed = 0;
                    for (size_t i = 0; i < bytes.size(); ++i) changed += bytes[i] != before[i];
                    EXPECT_LE(changed, 2u) << "a byte for each leaf that hears it";
                    std::vector<unsigned char> silent = before;
                    ASSERT_TRUE(writeAmbientLevels(silent, "made.bsp", rowsOfTwo(open), each.without).ok());
                    for (size_t leaf = 1; leaf <= 2; ++leaf) EXPECT_EQ(levelsOf(silent, format, leaf), "0000");
                }
    }
}

TEST(QuakeAmbient, RefusesRowsOfAnotherSize) {
    MadeMap map;
    madeVisibility(QuakeFormat::kQuake, true, map);
    std::vector<unsigned char> bytes = bytesOf(mapBytes(QuakeFormat::kQuake, map));
    EXPECT_EQ(writeAmbientLevels(bytes, "made.bsp", BitMatrix(3, 3)).error().message,
              "made.bsp: has 2 clusters, the visibility 3");
    bytes.resize(40);
    EXPECT_FALSE(writeAmbientLevels(bytes, "made.bsp", rowsOfTwo(true)).ok());
}

}  // namespace
}  // namespace sightline
