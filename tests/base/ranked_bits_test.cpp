// Bits that are counted and found, against counting one by one.
// SPDX-License-Identifier: MIT
#include "sightline/base/ranked_bits.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/base/random.h"

namespace sightline::test {
namespace {

TEST(RankedBits, AreCountedAndFound) {
    Random random(1);
    for (const size_t words : {0, 1, 2, 7, 100})
        for (const uint64_t kind : {0, 1, 2, 3}) {
            std::vector<uint64_t> given(words);
            for (uint64_t& word : given)
                word = kind == 0   ? 0
                       : kind == 1 ? ~uint64_t{0}
                       : kind == 2 ? random.next()
                                   : uint64_t{1} << random.below(64);
            const RankedBits bits(given, defaultMemory());
            uint32_t before = 0;
            for (uint32_t i = 0; i < 64 * words; ++i) {
                ASSERT_EQ(bits.rank(i), before);
                const bool set = given[i / 64] >> i % 64 & 1;
                ASSERT_EQ(bits.has(i), set);
                if (set) { ASSERT_EQ(bits.select(before), i); }
                before += set;
            }
            ASSERT_EQ(bits.rank(static_cast<uint32_t>(64 * words)), before);
            ASSERT_EQ(bits.count(), before);
        }
}

}  // namespace
}  // namespace sightline::test
