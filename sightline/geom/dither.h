// Which pixels show which of two levels while one is faded into the other: masks that leave no pixel out and none twice.
// SPDX-License-Identifier: MIT
//
// Bryce Bayer. An optimum method for two-level rendition of continuous-tone pictures. 1973.
#pragma once

#include <cstdint>

namespace sightline {

/// Thresholds of an 8 x 8 pattern, each of 1/128, 3/128 ... 127/128 once.
constexpr float ditherThreshold(uint32_t x, uint32_t y) {
    uint32_t rank = 0;
    for (uint32_t bit = 0; bit < 3; ++bit) {
        const uint32_t a = x >> bit & 1, b = y >> bit & 1;
        rank |= ((a ^ b) << 1 | b) << (4 - 2 * bit);
    }
    return (2.0f * static_cast<float>(rank) + 1.0f) / 128.0f;
}

/// True where a pixel shows the level that fades in, VisibleLod::level; it shows VisibleLod::from where this is false.
/// Both draws must use the same pixel coordinates, and so must passes of depth and of shadows.
constexpr bool showsFadedIn(uint32_t x, uint32_t y, float fade) { return ditherThreshold(x, y) < fade; }

}  // namespace sightline
