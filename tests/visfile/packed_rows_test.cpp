// Packed rows unpack to the same bytes, take fewer, and end whatever they are.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/packed_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/visfile/row_order.h"
#include "tests/support/memory.h"
#include "tests/visfile/made_rows.h"

namespace sightline::test {
namespace {

Array<char> packed(const Array<char>& tiled) { return packedRows(*VisibleRows::open(tiled, "rows")); }

TEST(PackedRows, UnpackToTheSameBytes) {
    for (const MadeRows& made : manyRows()) {
        SCOPED_TRACE(made.name);
        const Array<char> tiled = *tiledRows(made.matrix), bytes = packed(tiled);
        EXPECT_EQ(packed(tiled), bytes);
        const Result<Array<char>> again = unpackedRows(bytes, "rows");
        ASSERT_TRUE(again.ok()) << again.error().message;
        ASSERT_EQ(*again, tiled);
    }
}

TEST(PackedRows, TakeNoMoreThanTheBitsOfHalfTheMatrix) {
    for (const MadeRows& made : manyRows()) {
        const double n = double(made.matrix.rows());
        // A random order of cells is log2(n!) bits; coded by steps it may take twice that.
        const double order = 2 * n * std::log2(n + 2);
        EXPECT_LT(8.0 * double(packed(*tiledRows(made.matrix)).size()), 1.02 * n * n / 2 + order + 250) << made.name;
    }
    const BitMatrix grouped = groupedRows(1000, 60, 0.001, 1);
    EXPECT_LT(packed(*tiledRows(grouped)).size(), 9000u);
}

TEST(PackedRows, EndWithTheirBytes) {
    Array<char> bytes = packed(*tiledRows(groupedRows(100, 9, 0.02, 1)));
    bytes.push_back(0);  // past the end there is only zero anyway
    const Result<Array<char>> tiled = unpackedRows(bytes, "f", 40);
    ASSERT_FALSE(tiled.ok());
    EXPECT_EQ(tiled.error().message,
              "f: packed rows that do not end with their bytes at byte " + std::to_string(40 + bytes.size()));
}

TEST(PackedRows, OfWhatWasNeverPutAreRefusedOrUnpackToWhatCanBeLookedAt) {
    Random random(3);
    int unpacked = 0, opened = 0;
    for (int i = 0; i < 20000; ++i) {
        Array<char> bytes = packed(*tiledRows(groupedRows(1 + random.below(60), 6, 0.03, random.next())));
        for (uint64_t k = 0; k <= random.below(3); ++k)
            bytes[random.below(bytes.size())] ^= static_cast<char>(1u << random.below(8));
        if (random.below(4) == 0) bytes.resize(random.below(bytes.size()));
        const Result<Array<char>> tiled = unpackedRows(bytes, "a/map.see", 100);
        if (!tiled.ok()) {
            const std::string& line = tiled.error().message;
            ASSERT_EQ(line.rfind("a/map.see: ", 0), 0u) << line;
            ASSERT_EQ(line.find('\n'), std::string::npos) << line;
            continue;
        }
        ++unpacked;
        opened += VisibleRows::open(*tiled, "rows").ok();
    }
    EXPECT_GT(unpacked, 300);
    EXPECT_GT(opened, 100);
}

TEST(PackedRows, PromisesOfFewBytesTakeLittle) {
    // All that can be claimed in a head, and then all that bytes may code: the numbers of steps are bounded by the bytes.
    for (const char fill : {'\0', '\xff', '\x55'}) {
        Array<char> bytes(200, fill);
        for (const size_t at : {0, 4}) {
            bytes[at] = bytes[at + 1] = '\xff';
            bytes[at + 2] = bytes[at + 3] = 0;
        }
        CountingMemory counted;
        EXPECT_FALSE(unpackedRows(bytes, "rows", 0, &counted).ok());
        EXPECT_LT(counted.most, 4u << 20);
    }
    // A sound list of cells, and then no tiles, of which there would be 70 thousand.
    Array<char> no_tiles = packed(*tiledRows(onlyThemselves(3000)));
    const size_t whole = no_tiles.size();
    no_tiles.resize(whole - whole / 4);
    CountingMemory counted;
    EXPECT_FALSE(unpackedRows(no_tiles, "rows", 0, &counted).ok());
    EXPECT_LT(counted.most, 150u << 10);
}

}  // namespace
}  // namespace sightline::test
