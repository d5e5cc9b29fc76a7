// What drawing and testing do to one tile, compiled once per instruction set.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_RASTER_TILE_OPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RASTER_TILE_OPS_INL_H
#undef SIGHTLINE_RASTER_TILE_OPS_INL_H
#else
#define SIGHTLINE_RASTER_TILE_OPS_INL_H
#endif

#include <algorithm>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include "sightline/raster/tiles.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;
using F16 = hn::CappedTag<float, 16>;

/// A mask's lanes as bits, lane 0 the lowest; at most 16. Reads back just the bytes that were written, which a
/// compiler can keep in a register.
template <class D, class Mask>
HWY_INLINE uint64_t bitsFromMask(D d, Mask mask) {
    if constexpr (hn::MaxLanes(D()) > 8) {
        uint16_t bits;
        hn::StoreMaskBits(d, mask, reinterpret_cast<uint8_t*>(&bits));
        return bits;
    } else {
        uint8_t bits;
        hn::StoreMaskBits(d, mask, &bits);
        return bits;
    }
}

template <class D>
HWY_INLINE hn::Mask<D> maskFromBits(D d, uint64_t bits) {
    uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bits);
    return hn::LoadMaskBits(d, bytes);
}

/// A polygon's nearness over the pixels of a tile; see DepthTiles::plane_d.
struct TilePlane {
    float d = 0, dx = 0, dy = 0, floor = 0;
};

/// A plane's depths at the pixels of one row whose offsets from the tile's centre are given.
template <class D, class Vec>
HWY_INLINE Vec planeDepth(D d, const TilePlane& plane, int row, Vec x) {
    const auto base = hn::Set(d, plane.d + plane.dy * (static_cast<float>(row) - 3.5f));
    return hn::Max(hn::Add(base, hn::Mul(hn::Set(d, plane.dx), x)), hn::Set(d, plane.floor));
}

/// Writes a plane out, or -infinity for an empty tile, so that single pixels can change.
inline void toPixels(DepthTiles& tiles, uint32_t tile) {
    if (tiles.form[tile] == DepthTiles::Form::kPixels) return;
    const F8 d;
    const bool planar = tiles.form[tile] == DepthTiles::Form::kPlane;
    const auto open = hn::Set(d, -std::numeric_limits<float>::infinity());
    const auto offset = hn::Iota(d, -3.5f);
    const TilePlane plane{tiles.plane_d[tile], tiles.plane_dx[tile], tiles.plane_dy[tile], tiles.plane_floor[tile]};
    float* depth = tiles.depth.data() + 64 * size_t{tile};
    for (int row = 0; row < 8; ++row)
        for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
            const auto z =
                planar ? planeDepth(d, plane, row, hn::Add(offset, hn::Set(d, static_cast<float>(h)))) : open;
            hn::StoreU(z, d, depth + 8 * row + h);
        }
    tiles.covered[tile] = planar ? ~uint64_t{0} : 0;
    tiles.nearest[tile] = std::numeric_limits<float>::infinity();
    tiles.form[tile] = DepthTiles::Form::kPixels;
}

/// Pixels of a tile in form kPixels whose depth does not surely lie in front of the given nearness.
inline uint64_t pixelsNotNearer(const float* depth, float nearness) {
    const F16 d;
    const auto limit = hn::Set(d, nearness);
    uint64_t nearer = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        nearer |= bitsFromMask(d, hn::Gt(hn::LoadU(d, depth + i), limit)) << i;
    return ~nearer;
}

/// Bits of the pixels of a tile that an inclusive pixel rectangle meets; it must meet the tile.
HWY_INLINE uint64_t windowBits(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t tile_x, int32_t tile_y) {
    const int left = std::max(0, x0 - tile_x), right = std::min(7, x1 - tile_x);
    const int low = std::max(0, y0 - tile_y), high = std::min(7, y1 - tile_y);
    const uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left) & 0xffu;
    const uint64_t rows = ~uint64_t{0} << (8 * low) & ~uint64_t{0} >> (8 * (7 - high));
    return columns * 0x0101010101010101ull & rows;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
