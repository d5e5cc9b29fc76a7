// The visibility lump: what is packed is unpacked, in every format, and the rest of the file stays.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "map_check.h"
#include "mutated.h"
#include "map_files.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

bool byLeaf(QuakeFormat format) { return format != QuakeFormat::kQuake2 && format != QuakeFormat::kQuake3; }

/// Only what reads the lump needs.
QuakeMapFile mapOf(QuakeFormat format, const QuakeVisibilityLump& lump) {
    QuakeMapFile map;
    map.format = format;
    map.clusters = static_cast<uint32_t>(lump.row_offsets.size());
    map.visibility = lump.bytes;
    map.row_offsets = lump.row_offsets;
    return map;
}

/// Bits at any density, each row perhaps the same as one before it.
BitMatrix randomRows(size_t clusters, Random& random) {
    BitMatrix out(clusters, clusters);
    for (size_t row = 0; row < clusters; ++row) {
        const size_t other = random.below(3) ? row : random.below(row + 1);
        const uint64_t rarity = 1 + random.below(2000) * random.below(2);
        for (size_t column = 0; column < clusters; ++column)
            if (other != row ? out.at(other, column) : random.below(rarity) == 0) out.set(row, column);
    }
    return out;
}

TEST(QuakeVisibility, WhatIsPackedIsUnpacked) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const BitMatrix rows = randomRows(1 + random.below(seed % 10 == 0 ? 3000 : 200), random);
        for (const QuakeFormat format : kQuakeFormats) {
            const QuakeVisibilityLump lump = packQuakeVisibility(format, rows);
            const Result<QuakeVisibility> read = readQuakeVisibility(mapOf(format, lump), "test.bsp");
            ASSERT_TRUE(read.ok()) << read.error().message;
            EXPECT_EQ(read->seen, rows) << seed << " " << quakeFormatName(format);
            EXPECT_EQ(read->rows_missing, 0u);
        }
    }
}

TEST(QuakeVisibility, PacksRunsOfZeros) {
    BitMatrix rows(6000, 6000);
    for (size_t row = 0; row < 6000; ++row) rows.set(row, row < 3000 ? 8 : 5999);
    const QuakeVisibilityLump lump = packQuakeVisibility(QuakeFormat::kQuake, rows);
    // Two different rows of 750 bytes: 0 1 1 0 255 0 255 0 238, and 0 255 0 255 0 239 128.
    const std::vector<unsigned char> wanted = {0, 1, 1, 0, 255, 0, 255, 0, 238, 0, 255, 0, 255, 0, 239, 128};
    EXPECT_EQ(lump.bytes, wanted);
    EXPECT_EQ(lump.row_offsets[2999], 0);
    EXPECT_EQ(lump.row_offsets[3000], 9);
}

/// Each hears what any that it sees, sees: by a search two steps deep.
TEST(QuakeVisibility, Quake2HearsWhatIsSeenFromWhatIsSeen) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const BitMatrix rows = randomRows(1 + random.below(90), random);
        const Result<QuakeVisibility> read = readQuakeVisibility(
            mapOf(QuakeFormat::kQuake2, packQuakeVisibility(QuakeFormat::kQuake2, rows)), "test.bsp");
        ASSERT_TRUE(read.ok());
        for (size_t a = 0; a < rows.rows(); ++a)
            for (size_t c = 0; c < rows.rows(); ++c) {
                bool heard = false;
                for (size_t b = 0; b < rows.rows(); ++b) heard |= rows.at(a, b) && rows.at(b, c);
                ASSERT_EQ(read->heard.at(a, c), heard) << seed;
            }
    }
}

TEST(QuakeVisibility, WithoutALumpAllIsSeen) {
    for (const QuakeFormat format : kQuakeFormats) {
        const Result<QuakeMapFile> map = parseQuakeBsp(bytesOf(mapBytes(format, {})), "test.bsp");
        ASSERT_TRUE(map.ok());
        const Result<QuakeVisibility> read = readQuakeVisibility(*map, "test.bsp");
        ASSERT_TRUE(read.ok());
        EXPECT_EQ(read->seen.count(), 4u);
        EXPECT_EQ(read->rows_missing, 2u);
    }
}

TEST(QuakeVisibility, RowsBeyondTheLumpAreRefused) {
    QuakeMapFile map;
    map.clusters = 20;
    map.row_offsets.assign(20, 0);
    const auto expectLine = [&](std::vector<unsigned char> lump, const std::string& line) {
        map.visibility = std::move(lump);
        const Result<QuakeVisibility> read = readQuakeVisibility(map, "test.bsp");
        ASSERT_FALSE(read.ok()) << line;
        EXPECT_EQ(read.error().message, "test.bsp: visibility[0]: " + line);
    };
    expectLine({1, 2}, "the row that begins at byte 0 goes on beyond the lump's 2");
    expectLine({1, 2, 0}, "the row that begins at byte 0 goes on beyond the lump's 3");
    expectLine({1, 0, 0, 1}, "a run of no zeros at byte 1");
    map.row_offsets[0] = 7;
    expectLine({1, 2, 3}, "the row that begins at byte 7 goes on beyond the lump's 3");
    map.clusters = kMostClusters + 1;
    EXPECT_FALSE(readQuakeVisibility(map, "test.bsp").ok());
}

/// All lumps but visibility and, by leaf, the offsets in leaves are the same bytes.
void expectSameRest(const std::string& before, const std::string& after, QuakeFormat format) {
    const int lumps = format == QuakeFormat::kQuake2 ? 19 : format == QuakeFormat::kQuake3 ? 17 : 15;
    const int visibility = format == QuakeFormat::kQuake2 ? 3 : format == QuakeFormat::kQuake3 ? 16 : 4;
    const size_t leaf = format == QuakeFormat::kBsp2 ? 44 : format == QuakeFormat::kPsb2 ? 32 : 28;
    for (int i = 0; i < lumps; ++i) {
        if (i == visibility) continue;
        const MadeLump a = lumpOf(before, i), b = lumpOf(after, i);
        ASSERT_EQ(a.size, b.size) << i;
        if (a.size == 0) continue;
        EXPECT_EQ(a.offset % 4, b.offset % 4) << i;
        std::string x = before.substr(a.offset, a.size), y = after.substr(b.offset, b.size);
        if (byLeaf(format) && i == 10)
            for (size_t at = 4; at < x.size(); at += leaf) x.replace(at, 4, "----"), y.replace(at, 4, "----");
        EXPECT_EQ(x, y) << "lump " << i;
    }
}

std::string rewritten(const std::string& bytes, const BitMatrix& rows) {
    const Result<std::vector<unsigned char>> out = replaceQuakeVisibility(bytesOf(bytes), "test.bsp", rows);
    EXPECT_TRUE(out.ok()) << out.error().message;
    return out.ok() ? std::string(out->begin(), out->end()) : "";
}

BitMatrix rowsOf(const std::string& bytes) {
    const Result<QuakeMapFile> map = parseQuakeBsp(bytesOf(bytes), "test.bsp");
    EXPECT_TRUE(map.ok()) << map.error().message;
    const Result<QuakeVisibility> read = readQuakeVisibility(*map, "test.bsp");
    EXPECT_TRUE(read.ok()) << read.error().message;
    return read->seen;
}

TEST(QuakeVisibility, GoesIntoAFileAndComesBack) {
    BitMatrix closed(2, 2);
    closed.set(0, 0);
    closed.set(1, 1);
    BitMatrix open = closed;
    open.set(0, 1);
    open.set(1, 0);
    for (const QuakeFormat format : kQuakeFormats)
        for (const bool there : {false, true}) {
            MadeMap made;
            if (there) madeVisibility(format, true, made);
            const std::string before = mapBytes(format, made);
            EXPECT_EQ(rowsOf(before).count(), 4u);
            const std::string after = rewritten(before, closed);
            EXPECT_EQ(rowsOf(after), closed) << quakeFormatName(format);
            expectSameRest(before, after, format);
            EXPECT_EQ(rowsOf(rewritten(after, open)), open) << quakeFormatName(format);
            expectSameRest(before, rewritten(after, open), format);
        }
    EXPECT_FALSE(replaceQuakeVisibility(bytesOf(mapBytes(QuakeFormat::kQuake, {})), "x", BitMatrix(3, 3)).ok());
}

/// Lumps of later days lie behind the others: their list says where, and must move with them.
TEST(QuakeVisibility, ExtensionsMoveWithTheFile) {
    MadeMap made;
    madeVisibility(QuakeFormat::kBsp2, true, made);
    std::string bytes = mapBytes(QuakeFormat::kBsp2, made);
    const auto data = static_cast<uint32_t>(bytes.size() + 8 + 32);
    std::string list("BSPX\1\0\0\0RGBLIGHTING", 19);
    list.resize(8 + 32, '\0');
    list = patched(patched(list, 8 + 24, data), 8 + 28, uint32_t(5));
    bytes += list + "LIGHT";
    made.visibility.assign(40, '\1');
    const std::string wide = mapBytes(QuakeFormat::kBsp2, made) + list + "LIGHT";  // a lump that will shrink
    BitMatrix rows(2, 2);
    rows.set(0, 1);
    for (const std::string& before : {bytes, patched(wide, wide.size() - 5 - 8, data + 36)}) {
        const std::string after = rewritten(before, rows);
        const size_t place = after.find("BSPX");
        ASSERT_NE(place, std::string::npos);
        size_t end = 0;
        for (int i = 0; i < 15; ++i) end = std::max<size_t>(end, lumpOf(after, i).offset + lumpOf(after, i).size);
        EXPECT_EQ(place, (end + 3) / 4 * 4);
        uint32_t offset = 0;
        std::memcpy(&offset, after.data() + place + 8 + 24, 4);
        EXPECT_EQ(after.substr(offset, 5), "LIGHT");
        EXPECT_EQ(rowsOf(after), rows);
    }
}

TEST(QuakeVisibility, OverlappingLumpsAreNotRewritten) {
    MadeMap made;
    madeVisibility(QuakeFormat::kQuake, true, made);
    std::string bytes = mapBytes(QuakeFormat::kQuake, made);
    bytes = patched(bytes, 4 + 8 * 8, lumpOf(bytes, 4).offset);  // the light's
    bytes = patched(bytes, 8 + 8 * 8, uint32_t(4));
    const Result<std::vector<unsigned char>> out = replaceQuakeVisibility(bytesOf(bytes), "test.bsp", BitMatrix(2, 2));
    ASSERT_FALSE(out.ok());
    EXPECT_EQ(out.error().message, "test.bsp: lumps 4 and 8 overlap");
}

TEST(QuakeVisibility, RowsOfClustersFollowTheCellsOfTheirLeaves) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        QuakeMapFile map;
        const uint64_t leaves = 1 + random.below(60), cells = 1 + random.below(20);
        map.clusters = static_cast<uint32_t>(1 + random.below(30));
        std::vector<uint32_t> cell_of_leaf;
        for (uint64_t leaf = 0; leaf < leaves; ++leaf) {
            constexpr LeafContents kContents[] = {LeafContents::kEmpty, LeafContents::kLiquid, LeafContents::kSky,
                                                  LeafContents::kSolid};
            map.tree.contents.push_back(kContents[random.below(4)]);
            map.cluster_of_leaf.push_back(random.below(5) ? static_cast<uint32_t>(random.below(map.clusters)) : ~0u);
            cell_of_leaf.push_back(random.below(20) ? static_cast<uint32_t>(random.below(cells)) : ~0u);
        }
        const BitMatrix seen = randomRows(cells, random);
        const BitMatrix rows = clusterRows(map, seen, cell_of_leaf);
        BitMatrix wanted(map.clusters, map.clusters);
        for (uint64_t a = 0; a < leaves; ++a)
            for (uint32_t cluster = 0; cluster < map.clusters; ++cluster) {
                if (map.cluster_of_leaf[a] == ~0u) continue;
                if (cell_of_leaf[a] == ~0u && map.tree.contents[a] != LeafContents::kSolid) {
                    wanted.set(map.cluster_of_leaf[a], cluster);
                    if (map.tree.contents[a] != LeafContents::kSky) wanted.set(cluster, map.cluster_of_leaf[a]);
                }
                for (uint64_t b = 0; b < leaves; ++b)
                    if (map.cluster_of_leaf[b] == cluster && cell_of_leaf[a] != ~0u && cell_of_leaf[b] != ~0u &&
                        seen.at(cell_of_leaf[a], cell_of_leaf[b]))
                        wanted.set(map.cluster_of_leaf[a], cluster);
            }
        EXPECT_EQ(rows, wanted) << seed;
    }
}

/// The incumbent's own lumps, unpacked and packed again.
TEST(QuakeVisibilityOfRealMaps, GoesRoundAndLeavesTheRest) {
    struct Map {
        const char* name;
        double mean;  ///< visible leaves of a leaf
        size_t bytes;
    };
    for (const Map& made : {Map{"lq_e1m5", 371, 99675}, Map{"lq_e2m2", 364, 42318}, Map{"lq_e4m1", 1432, 46153},
                            Map{"lqdm3", 1646, 119385}}) {
        const std::string file = fmt::format("{}/maps/{}.vis.bsp", SIGHTLINE_SHARED_DIR, made.name);
        if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared maps are not there";
        const Result<std::string> before = readTextFile(file);
        ASSERT_TRUE(before.ok());
        const BitMatrix rows = rowsOf(*before);
        EXPECT_NEAR(double(rows.count()) / double(rows.rows()), made.mean, 1) << made.name;
        const std::string after = rewritten(*before, rows);
        EXPECT_EQ(rowsOf(after), rows) << made.name;
        expectSameRest(*before, after, QuakeFormat::kQuake);
        EXPECT_LE(lumpOf(after, 4).size, made.bytes) << made.name;
        // One row changed: the file is another one, and still itself.
        BitMatrix other = rows;
        std::ranges::fill(other.row(0), 0);
        EXPECT_EQ(rowsOf(rewritten(after, other)), other) << made.name;
    }
}

}  // namespace
}  // namespace sightline
