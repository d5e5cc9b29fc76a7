// Asks the depth tiles whether they hide a rectangle: the SIMD kernel of every occlusion test.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "sightline/raster/tiles.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/raster/occluded.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/raster/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// What a tile leaves open of a rectangle: pixels that are not surely nearer than the rectangle.
uint64_t openPixels(DepthTiles& tiles, uint32_t tile, const PixelRect& rect, int32_t column, int32_t row) {
    if (tiles.farthest[tile] > rect.nearness) return 0;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    if (tiles.form[tile] == DepthTiles::Form::kEmpty) return window;
    toPixels(tiles, tile);
    return window & pixelsNotNearer(tiles.depth.data() + 64 * size_t{tile}, rect.nearness);
}

/// Whether some pixel is open that no seam can close.
bool surelyOpen(const DepthTiles& tiles, uint32_t tile, uint64_t open) {
    uint64_t seams = 0;
    for (uint32_t at = tiles.seams[tile]; at != DepthTiles::kNone; at = tiles.entries[at].next)
        seams |= tiles.entries[at].mask;
    return open & (~seams | tiles.tried[tile]);
}

/// Calls `look` with each tile of the rectangle that is not wholly nearer; stops when it returns false.
template <class Look>
HWY_INLINE bool forOpenTiles(DepthTiles& tiles, const PixelRect& rect, Look look) {
    const F8 d;
    const auto limit = hn::Set(d, rect.nearness);
    const int32_t first = rect.x0 >> 3, last = rect.x1 >> 3;
    for (int32_t row = rect.y0 >> 3; row <= rect.y1 >> 3; ++row) {
        const float* farthest = tiles.farthest.data() + static_cast<size_t>(row) * tiles.stride;
        for (int32_t chunk = first & ~7; chunk <= last; chunk += 8) {
            uint32_t open = 0xffu << std::max(0, first - chunk) & 0xffu >> std::max(0, chunk + 7 - last);
            for (size_t h = 0; h < 8; h += hn::Lanes(d))
                open &= ~static_cast<uint32_t>(bitsFromMask(d, hn::Gt(hn::LoadU(d, farthest + chunk + h), limit)) << h);
            for (; open; open &= open - 1) {
                const int32_t column = chunk + std::countr_zero(open);
                if (!look(static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column), column, row))
                    return false;
            }
        }
    }
    return true;
}

bool isHiddenKernel(DepthTiles& tiles, const PixelRect& rect) {
    // First the cheap answer: one pixel that stays open makes the rectangle visible.
    bool undecided = false;
    const bool closed = forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        const uint64_t open = openPixels(tiles, tile, rect, column, row);
        undecided |= open != 0;
        return !open || !surelyOpen(tiles, tile, open);
    });
    if (!closed || !undecided) return closed;
    return forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        for (uint64_t open = openPixels(tiles, tile, rect, column, row); open; open &= open - 1) {
            const int bit = std::countr_zero(open);
            if (!resolveSeam(tiles, tile, bit)) return false;
            if (!(tiles.depth[64 * size_t{tile} + static_cast<size_t>(bit)] > rect.nearness)) return false;
        }
        return true;
    });
}

void writeOutKernel(DepthTiles& tiles, uint32_t tile) { toPixels(tiles, tile); }

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(isHiddenKernel);
HWY_EXPORT(writeOutKernel);

bool isHidden(DepthTiles& tiles, const PixelRect& rect) {
    return HWY_DYNAMIC_DISPATCH(isHiddenKernel)(tiles, rect);
}

void writeOut(DepthTiles& tiles, uint32_t tile) { HWY_DYNAMIC_DISPATCH(writeOutKernel)(tiles, tile); }

}  // namespace sightline
#endif  // HWY_ONCE
