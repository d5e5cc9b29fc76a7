// The masks of a fade: each pixel shows one of both levels, and as many show the new one as the fade says.
// SPDX-License-Identifier: MIT
#include "sightline/geom/dither.h"

#include <gtest/gtest.h>

#include <set>

namespace sightline {
namespace {

TEST(Dither, HasEachThresholdOnce) {
    std::set<float> seen;
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x) {
            seen.insert(ditherThreshold(x, y));
            EXPECT_EQ(ditherThreshold(x, y), ditherThreshold(x + 8, y + 16));
        }
    EXPECT_EQ(seen.size(), 64u);
    EXPECT_EQ(*seen.begin(), 1.0f / 128);
    EXPECT_EQ(*seen.rbegin(), 127.0f / 128);
}

TEST(Dither, ShowsAsMuchOfTheNewLevelAsTheFadeSays) {
    for (int step = 0; step <= 100; ++step) {
        const float fade = 0.01f * static_cast<float>(step);
        int shown = 0;
        for (uint32_t y = 0; y < 8; ++y)
            for (uint32_t x = 0; x < 8; ++x) shown += showsFadedIn(x, y, fade);
        EXPECT_NEAR(static_cast<float>(shown) / 64, fade, 1.0f / 64) << fade;
    }
    EXPECT_FALSE(showsFadedIn(0, 0, 0.0f));
    for (uint32_t i = 0; i < 64; ++i) EXPECT_TRUE(showsFadedIn(i % 8, i / 8, 1.0f));
}

TEST(Dither, NeighboursDifferByHalfThePatternInTheMean) {
    // What makes it Bayer's: every second pixel lies in the lower half of the thresholds, like a chessboard.
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x) EXPECT_EQ(showsFadedIn(x, y, 0.5f), ((x ^ y) & 1) == 0);
}

}  // namespace
}  // namespace sightline
