// Signs that are never wrong: exact numbers against whole ones, and rounded numbers against exact ones.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/exact_number.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/glm.hpp>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

__extension__ using Wide = __int128;

int signOf(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

TEST(ExactNumbers, HaveTheSignsOfWholeNumbers) {
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        Wide whole = 0;
        Exact exact;
        // Products that cancel in part or in whole, at places far apart.
        for (int term = 0; term < 4; ++term) {
            const auto a = static_cast<int64_t>(random.below(1u << 30)) - (1 << 29);
            const auto b = static_cast<int64_t>(random.below(5)) - 2;
            const int shift = 20 * static_cast<int>(random.below(4));
            whole += (static_cast<Wide>(a) * b) * (static_cast<Wide>(1) << shift);
            exact = exact + Exact(std::ldexp(double(a), shift - 30)) * Exact(std::ldexp(double(b), 30));
        }
        ASSERT_EQ(exact.sign(), signOf(whole)) << i;
        ASSERT_EQ((exact - exact).sign(), 0);
        ASSERT_EQ((-exact).sign(), -exact.sign());
    }
}

TEST(ExactNumbers, LoseNothingBetweenTheSmallestAndTheLargest) {
    const Exact tiny(0x1p-1074), huge(0x1.fffffffffffffp1023);
    EXPECT_EQ((huge + tiny - huge - tiny).sign(), 0);
    EXPECT_EQ((huge + tiny - huge).sign(), 1);
    EXPECT_EQ((tiny * tiny).sign(), 1);
    EXPECT_EQ((huge * huge - huge * huge - tiny * tiny).sign(), -1);
}

/// The same random sums of products in both: what the rounded one is sure of must be so.
TEST(RoundedNumbers, AreNeverSureOfWhatIsWrong) {
    int sure = 0, unsure = 0;
    for (uint64_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        Rounded rounded = random.uniform(-1, 1);
        Exact exact(rounded.value);
        for (int step = 0; step < 6; ++step) {
            const double value = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.below(30)) - 15);
            const Rounded before = rounded;
            switch (random.below(4)) {
                case 0:
                    rounded = rounded + value;
                    exact = exact + Exact(value);
                    break;
                case 1:
                    rounded = rounded * value;
                    exact = exact * Exact(value);
                    break;
                case 2:
                    rounded = rounded - rounded.value;  // next to nothing is left
                    exact = exact - Exact(before.value);
                    break;
                default:
                    rounded = rounded * rounded - value * value;
                    exact = exact * exact - Exact(value) * Exact(value);
            }
        }
        const int sign = rounded.sign();
        if (sign == Rounded::kUnknown) {
            ++unsure;
            continue;
        }
        ++sure;
        ASSERT_EQ(sign, exact.sign()) << "seed " << seed;
    }
    EXPECT_GT(sure, 10000);
    EXPECT_GT(unsure, 100);
}

/// Three points and their sum's third part, rounded: how far it is from the plane, which only exact numbers know.
TEST(RoundedNumbers, SayWhenTheyDoNotKnow) {
    int unsure = 0;
    for (uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        const auto point = [&] {
            return glm::dvec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
        };
        const glm::dvec3 a = point(), b = point(), c = point(), d = (a + b + c) / 3.0;
        const auto side = [&](auto number) {
            using Number = decltype(number);
            const auto of = [](const glm::dvec3& p) { return Triple<Number>{Number(p.x), Number(p.y), Number(p.z)}; };
            return dot(cross(of(b) - of(a), of(c) - of(a)), of(d) - of(a)).sign();
        };
        const int sign = side(Rounded());
        if (sign == Rounded::kUnknown) ++unsure;
        else ASSERT_EQ(sign, side(Exact())) << "seed " << seed;
    }
    EXPECT_GT(unsure, 1000);
}

}  // namespace
}  // namespace sightline
