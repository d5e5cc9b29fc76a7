// Which planes cover which pixels of a tile: what lies wholly behind them is hidden there, whatever the depths.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/covers.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/ablate.h"
#include "sightline/base/assert.h"

namespace sightline {

void noteCover(DepthTiles& tiles, uint32_t tile, uint64_t mask, const PlaneSet& planes) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && mask != 0);
    if (detail::kAblate.planes || planes.empty()) return;
    TileCover* const covers = tiles.covers.data() + DepthTiles::kCovers * size_t{tile};
    uint8_t& count = tiles.cover_count[tile];
    SIGHTLINE_DEBUG_ASSERT(count <= DepthTiles::kCovers);
    TileCover* const end = covers + count;
    if (TileCover* const same = std::find_if(covers, end, [&](const TileCover& c) { return c.planes == planes; });
        same != end) {
        same->mask |= mask;
    } else if (count < DepthTiles::kCovers) {
        *end = {mask, planes};
        ++count;
    } else {
        const auto fewer = [](const TileCover& a, const TileCover& b) {
            return std::popcount(a.mask) < std::popcount(b.mask);
        };
        TileCover* const least = std::min_element(covers, end, fewer);
        if (std::popcount(mask) > std::popcount(least->mask)) *least = {mask, planes};
    }
}

uint32_t findPlane(const DepthTiles& tiles, const double* x, const double* y, const double* d, int count, double error,
                   size_t first, size_t most) {
    SIGHTLINE_DEBUG_ASSERT(count >= 3 && error >= 0);
    const size_t end = tiles.planes.size(), stop = std::max(first, end - std::min(end, most));
    for (size_t i = end; i-- > stop;) {
        const BufferPlane& plane = tiles.planes[i];
        double off = 0;
        for (int k = 0; k < count; ++k)
            off = std::max(off, std::abs(plane.d0 + plane.dx * x[k] + plane.dy * y[k] - d[k]));
        if (off + error + 0x1p-48 * std::abs(plane.d0) <= static_cast<double>(plane.error))
            return static_cast<uint32_t>(i);
    }
    return DepthTiles::kNone;
}

uint64_t openToBox(const DepthTiles& tiles, uint32_t tile, uint64_t open, const OccludeeBox& box) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && open != 0);
    SIGHTLINE_DEBUG_ASSERT(tiles.cover_count[tile] <= DepthTiles::kCovers);
    if (isBehindBase(tiles, tile, box)) return 0;
    const TileCover* const covers = tiles.covers.data() + DepthTiles::kCovers * size_t{tile};
    for (uint32_t i = 0; i < tiles.cover_count[tile] && open; ++i)
        if ((covers[i].mask & open) && box.isBehind(tiles, covers[i].planes)) open &= ~covers[i].mask;
    return open;
}

}  // namespace sightline
