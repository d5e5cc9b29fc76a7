// Depth of an image in blocks of 32x16 pixels: of each tile of 8x8 a base and its plane, and beside them a depth by pixel.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sightline/base/assert.h"

namespace sightline::bench {

constexpr int kBlockWidth = 32, kBlockHeight = 16, kBlockTiles = 8;

/// Nearness (1 / w) by pixel in 16 bits, rounded away from the eye: five bits of an exponent and eleven behind it. 0: open.
struct PixelDepths {
    int32_t least = 0;  ///< bits of the float that the code 1 stands for, less 4096

    /// @param farthest  what is farther counts as open  [nearness]
    explicit PixelDepths(float farthest = 1e-6f)
        : least(static_cast<int32_t>(std::bit_cast<uint32_t>(farthest) & ~0xfffu) - 4096) {}
    uint16_t code(float nearness) const {
        if (!(nearness > 0)) return 0;
        const int64_t code = (int64_t{std::bit_cast<int32_t>(nearness)} - least) >> 12;
        return static_cast<uint16_t>(code < 0 ? 0 : code > 65534 ? 65534 : code);
    }
    float nearness(uint16_t code) const {
        return code == 0 ? -std::numeric_limits<float>::infinity()
                         : std::bit_cast<float>((int32_t{code} << 12) + least);
    }
};

/// Nearness of a plane in the image: a x + b y + c, no more than that of any of its points.
struct ImagePlane {
    float a, b, c;
};

struct alignas(64) DepthBlock {
    static constexpr uint32_t kNoPlane = ~0u;

    float base[kBlockTiles];      ///< no pixel of the tile is farther; the upper four tiles first
    uint32_t plane[kBlockTiles];  ///< that covers the tile, or kNoPlane
    uint64_t seen[kBlockTiles];   ///< pixels with a code, bit 8 * row + column; codes of a tile without are not set
    alignas(64) uint16_t codes[kBlockHeight][kBlockWidth];

    void clear() {
        for (int t = 0; t < kBlockTiles; ++t) {
            base[t] = -std::numeric_limits<float>::infinity();
            plane[t] = kNoPlane;
            seen[t] = 0;
        }
    }
};

/// The image.
struct DepthBlocks {
    uint32_t width = 0, height = 0;  ///< [pixels]
    int columns = 0, rows = 0;       ///< [blocks]
    PixelDepths depths;
    std::vector<DepthBlock> blocks;
    std::vector<float>
        least_base;  ///< per block the least of its tiles' bases; rows of `stride`, infinite behind the last column
    int stride = 0;
    std::vector<ImagePlane> planes;

    void clear(uint32_t w, uint32_t h, float farthest) {
        width = w;
        height = h;
        columns = static_cast<int>((w + kBlockWidth - 1) / kBlockWidth);
        rows = static_cast<int>((h + kBlockHeight - 1) / kBlockHeight);
        depths = PixelDepths(farthest);
        blocks.resize(static_cast<size_t>(columns) * static_cast<size_t>(rows));
        for (DepthBlock& block : blocks) block.clear();
        stride = (columns + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
        least_base.assign(static_cast<size_t>(stride) * static_cast<size_t>(rows),
                          std::numeric_limits<float>::infinity());
        for (int row = 0; row < rows; ++row)
            std::fill_n(&leastBase(0, row), columns, -std::numeric_limits<float>::infinity());
        planes.clear();
    }
    DepthBlock& at(int column, int row) {
        SIGHTLINE_DEBUG_ASSERT(column >= 0 && column < columns && row >= 0 && row < rows);
        return blocks[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
    }

    float& leastBase(int column, int row) {
        return least_base[static_cast<size_t>(row) * static_cast<size_t>(stride) + static_cast<size_t>(column)];
    }

    /// What a pixel claims; infinitely far where it is open.
    float claim(int x, int y) {
        const DepthBlock& block = at(x / kBlockWidth, y / kBlockHeight);
        const int column = x % kBlockWidth, row = y % kBlockHeight, tile = 4 * (row / 8) + column / 8;
        const bool seen = block.seen[tile] >> (8 * (row % 8) + column % 8) & 1;
        const float by_pixel =
            seen ? depths.nearness(block.codes[row][column]) : -std::numeric_limits<float>::infinity();
        return by_pixel > block.base[tile] ? by_pixel : block.base[tile];
    }
};

}  // namespace sightline::bench
