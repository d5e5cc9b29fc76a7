// Bits in levels say of every range what plain bits say.
// SPDX-License-Identifier: MIT
#include "sightline/base/levelled_bits.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
namespace {

/// Asks about ranges, random ones and those that begin or end where words do.
template <class Bits>
void expectSame(const Bits& bits, const std::set<uint32_t>& wanted, uint32_t size, Random& random) {
    for (int round = 0; round < 200; ++round) {
        uint32_t first = random.below(size + 1), end = first + random.below(size - first + 1);
        if (round % 3 == 0) first = first / 64 * 64;
        if (round % 5 == 0) end = std::min(size, (end + 63) / 64 * 64);
        if (first > end) std::swap(first, end);
        const auto from = wanted.lower_bound(first), to = wanted.lower_bound(end);
        EXPECT_EQ(bits.any(first, end), from != to) << first << " " << end;
        std::vector<uint32_t> found;
        bits.forEachWord(first, end, [&](uint32_t word, uint64_t some) {
            EXPECT_NE(some, 0u);
            for (uint32_t bit = 0; bit < 64; ++bit)
                if (some >> bit & 1) found.push_back(64 * word + bit);
        });
        EXPECT_EQ(found, std::vector<uint32_t>(from, to)) << first << " " << end;
    }
}

TEST(LevelledBits, SayOfRangesWhatASetSays) {
    Random random(1);
    LevelledBits bits;
    for (const uint32_t size : {1u, 63u, 64u, 65u, 4096u, 5000u, 300000u, 700001u, 130u}) {
        for (const uint32_t count : {0u, 1u, 3u, 40u, 1000u}) {
            bits.clear(size);
            std::set<uint32_t> wanted;
            for (uint32_t i = 0; i < count; ++i) {
                const uint32_t number =
                    random.below(3) ? random.below(size) : size - 1 - random.below(std::min(size, 70u));
                EXPECT_EQ(bits.insert(number), wanted.insert(number).second);
                EXPECT_TRUE(bits.has(number));
            }
            expectSame(bits, wanted, size, random);
        }
    }
}

TEST(PagedBits, ChangeWhileSharesStayAsTheyAre) {
    Random random(2);
    PagedBits bits;
    std::set<uint32_t> now;
    uint32_t size = 0;
    for (int round = 0; round < 30; ++round) {
        if (round == 15) {
            bits.clear();
            now.clear();
            size = 0;
        }
        size += random.below(30000) + 1;
        bits.resize(size);
        for (int i = 0; i < 200; ++i) {
            const uint32_t number = random.below(size);
            const bool value = random.below(2);
            bits.set(number, value);
            if (value) now.insert(number);
            else now.erase(number);
            EXPECT_EQ(bits.has(number), value);
        }
        const PagedBits shared = bits.share();
        const std::set<uint32_t> before = now;
        for (int i = 0; i < 50; ++i) {
            const uint32_t number = random.below(size);
            bits.set(number, !now.count(number));
            if (!now.erase(number)) now.insert(number);
        }
        expectSame(shared, before, size, random);
        expectSame(bits, now, size, random);
    }
}

}  // namespace
}  // namespace sightline
