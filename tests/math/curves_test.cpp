// The laws of curves that fill a box: each cell once, and of Hilbert's no jump.
// SPDX-License-Identifier: MIT
#include "sightline/math/curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace sightline::test {
namespace {

TEST(Curves, HilbertsGoesThroughEveryCellFromNeighbourToNeighbour) {
    constexpr uint32_t kSide = 32;  // the curve fills this corner of its cube before it goes on
    std::vector<glm::ivec3> at(kSide * kSide * kSide, glm::ivec3(-1));
    for (uint32_t x = 0; x < kSide; ++x)
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t z = 0; z < kSide; ++z) {
                const uint32_t code = hilbertCode(x, y, z);
                ASSERT_LT(code, at.size());
                ASSERT_EQ(at[code].x, -1) << "each code once";
                at[code] = glm::ivec3(x, y, z);
            }
    for (size_t i = 1; i < at.size(); ++i) {
        const glm::ivec3 step = glm::abs(at[i] - at[i - 1]);
        ASSERT_EQ(step.x + step.y + step.z, 1) << "from " << i - 1 << " to " << i;
    }
}

TEST(Curves, CodesUseAllBits) {
    EXPECT_EQ(hilbertCode(0, 0, 0), 0u);
    uint32_t all = 0;
    for (const uint32_t x : {0u, 1023u})
        for (const uint32_t y : {0u, 1023u})
            for (const uint32_t z : {0u, 1023u}) all = std::max(all, hilbertCode(x, y, z));
    EXPECT_EQ(all, (1u << 30) - 1) << "it ends in a corner";
    const Box3d box{glm::dvec3(-1.0), glm::dvec3(1.0, 3.0, 5.0)};
    EXPECT_EQ(mortonCode(box.min, box), 0u);
    EXPECT_EQ(mortonCode(box.max, box), (uint64_t{1} << 63) - 1);
    EXPECT_EQ(mortonCode({-9.0, 9.0, -9.0}, box), mortonCode({-1.0, 3.0, -1.0}, box));
    EXPECT_EQ(mortonCode({1.0, -1.0, -1.0}, box), everyThirdBit(0x1fffff));
}

TEST(Curves, EveryThirdBitIsThatOfTheNumber) {
    for (int bit = 0; bit < 21; ++bit) EXPECT_EQ(everyThirdBit(uint64_t{1} << bit), uint64_t{1} << (3 * bit));
    EXPECT_EQ(everyThirdBit(0b1011), uint64_t{0b1000001001});
}

}  // namespace
}  // namespace sightline::test
