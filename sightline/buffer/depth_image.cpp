// The depth that every pixel of the occlusion buffer claims, as one image: for pictures, and to see what went wrong.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/depth_image.h"

#include <algorithm>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/buffer/tile_log.h"

namespace sightline {
void readDepthImage(DepthTiles& tiles, Seams seams, std::span<float> nearness, std::span<uint8_t> covered, float open) {
    const size_t pixels = size_t{tiles.width} * tiles.height;
    SIGHTLINE_ASSERT(nearness.size() >= pixels && (covered.empty() || covered.size() >= pixels));
    SIGHTLINE_DEBUG_ASSERT(tiles.end_column <= tiles.columns && tiles.columns <= tiles.stride);
    TileLog* const log = std::exchange(tiles.log, nullptr);  // looking is not what the frame did
    float nothing_is_nearer[64], claims[64];
    std::fill(std::begin(nothing_is_nearer), std::end(nothing_is_nearer), std::numeric_limits<float>::infinity());
    for (uint32_t row = 0; row < tiles.rows; ++row)
        for (uint32_t column = tiles.first_column; column < tiles.end_column; ++column) {
            const uint32_t tile = row * tiles.stride + column;
            if (seams == Seams::kResolve) openPixels(tiles, tile, ~uint64_t{0}, nothing_is_nearer, seams);
            readClaims(tiles, tile, claims);
            for (uint32_t i = 0; i < 64; ++i) {
                const size_t at = size_t{8 * row + i / 8} * tiles.width + 8 * column + i % 8;
                const bool claimed = claims[i] > -std::numeric_limits<float>::infinity();
                nearness[at] = claimed ? claims[i] : open;
                if (!covered.empty()) covered[at] = claimed;
            }
        }
    tiles.log = log;
}

}  // namespace sightline
