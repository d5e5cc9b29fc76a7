// Cells of leaves unpack to what they were, and take little where leaves follow one another.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/leaf_cells.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/cells/cells.h"

namespace sightline {
namespace {

std::vector<uint32_t> someLeaves(uint64_t seed, size_t count, uint32_t cells) {
    Random random(seed);
    std::vector<uint32_t> leaves;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t how = random.below(10);
        if (how == 0) leaves.push_back(CellGraph::kNoCell);
        else if (how < 5 && !leaves.empty()) leaves.push_back(leaves.back());
        else leaves.push_back(static_cast<uint32_t>(random.below(cells)));
    }
    return leaves;
}

TEST(LeafCells, UnpackToTheSameNumbers) {
    for (uint64_t seed = 1; seed < 40; ++seed) {
        const std::vector<uint32_t> leaves = someLeaves(seed, (seed - 1) * 7, seed % 3 ? 50 : 65535);
        const Array<char> plain = leafCells(leaves), packed = packedLeafCells(leaves);
        ASSERT_EQ(plain.size(), 2 * leaves.size());
        for (size_t i = 0; i < leaves.size(); ++i) {
            const unsigned cell =
                static_cast<unsigned char>(plain[2 * i]) | static_cast<unsigned char>(plain[2 * i + 1]) << 8;
            ASSERT_EQ(cell, leaves[i] == CellGraph::kNoCell ? 65535u : leaves[i]);
        }
        const Result<Array<char>> again = unpackedLeafCells(packed, "f");
        ASSERT_TRUE(again.ok()) << again.error().message;
        ASSERT_EQ(*again, plain);
    }
}

TEST(LeafCells, InTheOrderOfATreeTakeLittle) {
    std::vector<uint32_t> leaves;
    for (uint32_t i = 0; i < 6000; ++i) leaves.push_back(i / 3);
    EXPECT_LT(packedLeafCells(leaves).size(), 800u);
}

TEST(LeafCells, OfWhatWasNeverPutAreRefusedOrNumbers) {
    Random random(5);
    int unpacked = 0;
    for (int i = 0; i < 20000; ++i) {
        Array<char> bytes = packedLeafCells(someLeaves(random.next(), 40, 30));
        for (uint64_t k = 0; k <= random.below(3); ++k)
            bytes[random.below(bytes.size())] ^= static_cast<char>(1u << random.below(8));
        if (random.below(4) == 0) bytes.resize(random.below(bytes.size()));
        const Result<Array<char>> plain = unpackedLeafCells(bytes, "f", 10);
        unpacked += plain.ok();
        if (plain.ok()) continue;
        ASSERT_EQ(plain.error().message.rfind("f: packed leaves", 0), 0u) << plain.error().message;
    }
    EXPECT_GT(unpacked, 100);
    Array<char> longer = packedLeafCells(someLeaves(1, 40, 30));
    longer.push_back(0);
    EXPECT_EQ(unpackedLeafCells(longer, "f", 10).error().message,
              "f: packed leaves that do not end with their bytes at byte " + std::to_string(10 + longer.size()));
    Array<char> many(4, '\xff');  // four thousand million leaves, and not a bit for them
    EXPECT_FALSE(unpackedLeafCells(many, "f").ok());
    EXPECT_FALSE(unpackedLeafCells({}, "f").ok());
}

}  // namespace
}  // namespace sightline
