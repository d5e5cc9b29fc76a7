// Which pixels of those asked about the depth tiles leave open, and the one that lies deepest among them.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/open_pixels.h"

#include <algorithm>
#include <cstdlib>

namespace sightline::detail {
namespace {

bool isOpen(DepthTiles& tiles, const AskedPixels& asked, int32_t x, int32_t y) {
    const float nearness = asked.at(x, y);
    return nearness != AskedPixels::kNotAsked &&
           !isHidden(tiles, {x, y, x, y, nearness}, Seams::kResolve, asked.box ? &*asked.box : nullptr);
}

bool isCovered(DepthTiles& tiles, int32_t x, int32_t y) {
    const uint32_t tile = static_cast<uint32_t>(y >> 3) * tiles.stride + static_cast<uint32_t>(x >> 3);
    return tiles.coveredBits(tile) >> (8 * (y & 7) + (x & 7)) & 1;
}

}  // namespace

void OpenPixels::run(DepthTiles& tiles, const AskedPixels& asked) {
    const PixelRect& rect = asked.rect;
    const int32_t width = rect.x1 - rect.x0 + 1, height = rect.y1 - rect.y0 + 1;
    pixels = 0;
    for (const float nearness : asked.nearness) pixels += nearness != AskedPixels::kNotAsked;
    open = 0;
    x = rect.x0;
    y = rect.y0;
    depth.assign(asked.nearness.size(), 0);
    const auto at = [&](int32_t column, int32_t row) -> uint32_t& {
        return depth[static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column)];
    };
    for (int32_t row = 0; row < height; ++row)
        for (int32_t column = 0; column < width; ++column)
            if (isOpen(tiles, asked, rect.x0 + column, rect.y0 + row)) at(column, row) = ~0u - 1, ++open;
    // Steps along rows and columns; what lies outside of the rectangle is not open.
    const auto step = [&](int32_t column, int32_t row, int32_t by) {
        uint32_t& here = at(column, row);
        if (here == 0) return;
        const auto steps = [&](int32_t c, int32_t r) {
            return c < 0 || r < 0 || c >= width || r >= height ? 0 : at(c, r);
        };
        here = std::min(here, 1 + std::min(steps(column + by, row), steps(column, row + by)));
    };
    for (int32_t row = 0; row < height; ++row)
        for (int32_t column = 0; column < width; ++column) step(column, row, -1);
    uint32_t deepest = 0;
    int32_t farthest = 0;  // of those that are as deep, from the middle, twice
    for (int32_t row = height; row-- > 0;)
        for (int32_t column = width; column-- > 0;) {
            step(column, row, 1);
            const uint32_t here = at(column, row);
            const int32_t off = std::abs(2 * column + 1 - width) + std::abs(2 * row + 1 - height);
            if (here == 0 || here < deepest || (here == deepest && off >= farthest)) continue;
            if (!isOpen(tiles, asked, rect.x0 + column, rect.y0 + row)) continue;
            deepest = here;
            farthest = off;
            x = rect.x0 + column;
            y = rect.y0 + row;
        }
    covered = isCovered(tiles, x, y);
}

}  // namespace sightline::detail
