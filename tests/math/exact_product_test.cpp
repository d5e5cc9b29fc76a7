// Products of doubles without rounding, held to whole numbers of 128 bits.
// SPDX-License-Identifier: MIT
#include "sightline/math/exact_product.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sightline::test {
namespace {

__extension__ using Whole = __int128;

/// Whole numbers of 53 bits; often a pair whose product is about that of another.
double someWhole(Random& random) {
    const double size = static_cast<double>(random.below(uint64_t{1} << 53));
    return random.below(2) ? size : -size;
}

double nearTo(double value, Random& random) { return value + static_cast<double>(random.below(5)) - 2.0; }

TEST(ExactProduct, IsTheProductAndWhatItLacks) {
    Random random(1);
    for (size_t i = 0; i < casesToMake(200000); ++i) {
        const double a = someWhole(random), b = someWhole(random);
        EXPECT_TRUE(Whole(a) * Whole(b) == Whole(a * b) + Whole(productError(a, b))) << a << " " << b;
    }
}

TEST(ExactProduct, DifferencesAreRightToTwoUnitsAndNeverZeroByMistake) {
    Random random(2);
    size_t cancelled = 0, equal = 0;
    for (size_t i = 0; i < casesToMake(200000); ++i) {
        double a = someWhole(random), b = someWhole(random), c = someWhole(random), d = someWhole(random);
        if (i % 4 == 1) c = nearTo(a, random), d = nearTo(b, random);
        if (i % 4 == 2) c = nearTo(b, random), d = a;
        if (i % 4 == 3) {  // whose doubles differ by a few units in the last place, or by none
            a = static_cast<double>(random.below(1 << 26)), b = static_cast<double>(random.below(1 << 26));
            const double times = static_cast<double>(1 + random.below(1 << 20));
            c = a * times, d = b;
            b = b * times;
            if (random.below(2)) d = nearTo(d, random);
        }
        const Whole exact = Whole(a) * Whole(b) - Whole(c) * Whole(d);
        const double answer = differenceOfProducts(a, b, c, d);
        const Whole off = Whole(answer) - exact, size = exact < 0 ? -exact : exact;
        // Two units in the last place are at most 2^-51 of the number.
        EXPECT_TRUE((off < 0 ? -off : off) <= size >> 51) << a << " " << b << " " << c << " " << d;
        EXPECT_EQ(equalProducts(a, b, c, d), exact == 0);
        cancelled += size < Whole(std::abs(a * b)) >> 40;
        equal += exact == 0;
    }
    EXPECT_GT(cancelled, 10000u);
    EXPECT_GT(equal, 10000u);
}

}  // namespace
}  // namespace sightline::test
