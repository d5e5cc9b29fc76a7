// Exact sums against whole numbers: the sign is right, whatever cancels.
// SPDX-License-Identifier: MIT
#include "sightline/math/expansion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/base/random.h"

namespace sightline {
namespace {

__extension__ using Whole = __int128;

TEST(Expansion, TopThatCancelsLeavesWhatIsBelow) {
    Expansion sum;
    for (double value : {3.0, 0x1p120, -0x1p120}) sum.add(value);
    EXPECT_EQ(sum.sign(), 1);
    sum.add(-3.0);
    EXPECT_EQ(sum.sign(), 0);
    sum.add(-0x1p-300);
    EXPECT_EQ(sum.sign(), -1);
}

TEST(Expansion, SignsAgreeWithWholeNumbers) {
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        // Numbers of a few bits at places far apart, so that many sums cancel in part or in whole.
        Random random(seed);
        Expansion sum;
        Whole truth = 0;
        for (int i = 0; i < 24; ++i) {
            const int shift = static_cast<int>(random.below(4)) * 38;
            const int64_t factor = static_cast<int64_t>(random.below(5)) - 2;
            sum.add(std::ldexp(static_cast<double>(factor), shift - 60));
            truth += static_cast<Whole>(factor) * (static_cast<Whole>(1) << shift);
            ASSERT_EQ(sum.sign(), truth > 0 ? 1 : truth < 0 ? -1 : 0) << "seed " << seed << ", term " << i;
        }
    }
}

}  // namespace
}  // namespace sightline
