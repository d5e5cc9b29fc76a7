// What drawing and testing do to one tile, compiled once per instruction set.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_TILE_OPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_TILE_OPS_INL_H
#undef SIGHTLINE_BUFFER_TILE_OPS_INL_H
#else
#define SIGHTLINE_BUFFER_TILE_OPS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include "sightline/base/assert.h"
#include "sightline/buffer/tiles.h"

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

/// A polygon's nearness over the pixels of a tile: at pixel (x, y) no point of it is farther than
/// max(floor, d + dx (x - 3.5) + dy (y - 3.5)).
struct TilePlane {
    float d = 0, dx = 0, dy = 0, floor = 0;
};

HWY_INLINE TilePlane planeInTile(const BufferPlane& plane, uint32_t column, uint32_t row) {
    const double x = 8.0 * column + 4.0, y = 8.0 * row + 4.0;
    const double tilt = std::abs(plane.dx) + std::abs(plane.dy), z = plane.d0 + plane.dx * x + plane.dy * y;
    const double error = plane.error + 0x1p-21 * (std::abs(z) + 8.0 * tilt);  // of float: here and at the pixels
    return {static_cast<float>(z - 0.5 * tilt - error), static_cast<float>(plane.dx), static_cast<float>(plane.dy),
            plane.floor};
}

/// A plane's depths at the pixels of a tile from the i-th on.
template <class D>
HWY_INLINE hn::Vec<D> planeDepths(D d, const TilePlane& plane, size_t i) {
    SIGHTLINE_DEBUG_ASSERT(i < 64 && i % hn::Lanes(d) == 0);
    alignas(64) static constexpr float kColumn[16] = {-3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                      -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    alignas(64) static constexpr float kRow[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    const auto column = hn::Load(d, kColumn + i % 16);
    const auto row = hn::Add(hn::Load(d, kRow + i % 16), hn::Set(d, static_cast<float>(i / 16 * 2) - 3.5f));
    const auto base = hn::Add(hn::Set(d, plane.d), hn::Mul(hn::Set(d, plane.dy), row));
    return hn::Max(hn::Add(base, hn::Mul(hn::Set(d, plane.dx), column)), hn::Set(d, plane.floor));
}

/// Writes a plane's depths at all pixels of a tile.
HWY_INLINE void planeDepths(const TilePlane& plane, float* depths) {
    const F16 d;
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) hn::StoreU(planeDepths(d, plane, i), d, depths + i);
}

/// Which of 64 depths are greater than a nearness.
HWY_INLINE uint64_t pixelsNearer(const float* depths, float nearness) {
    const F16 d;
    const auto limit = hn::Set(d, nearness);
    uint64_t nearer = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        nearer |= bitsFromMask(d, hn::Gt(hn::LoadU(d, depths + i), limit)) << i;
    return nearer;
}

/// Bits of the pixels of a tile that an inclusive pixel rectangle meets; it must meet the tile.
HWY_INLINE uint64_t windowBits(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t tile_x, int32_t tile_y) {
    SIGHTLINE_DEBUG_ASSERT(tile_x % 8 == 0 && x0 <= tile_x + 7 && tile_x <= x1 && x0 <= x1);
    SIGHTLINE_DEBUG_ASSERT(tile_y % 8 == 0 && y0 <= tile_y + 7 && tile_y <= y1 && y0 <= y1);
    const int left = std::max(0, x0 - tile_x), right = std::min(7, x1 - tile_x);
    const int low = std::max(0, y0 - tile_y), high = std::min(7, y1 - tile_y);
    const uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left) & 0xffu;
    const uint64_t rows = ~uint64_t{0} << (8 * low) & ~uint64_t{0} >> (8 * (7 - high));
    return columns * 0x0101010101010101ull & rows;
}

/// Gives a tile a block, in which nothing is written yet.
inline float* newBlock(DepthTiles& tiles, uint32_t tile) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.block.size());
    const size_t first = 64 * size_t{tiles.block_count};
    if (tiles.blocks.size() < first + 64) tiles.blocks.resize(2 * first + 64 * size_t{64});
    tiles.block[tile] = tiles.block_count++;
    SIGHTLINE_DEBUG_ASSERT(tiles.blocks.size() >= 64 * size_t{tiles.block_count});
    return tiles.blocks.data() + first;
}

/// A tile's block, or null.
HWY_INLINE float* blockOf(DepthTiles& tiles, uint32_t tile) {
    if (!(tiles.layer[tile] > DepthTiles::kOpen) || tiles.block[tile] == DepthTiles::kNone) return nullptr;
    SIGHTLINE_DEBUG_ASSERT(tiles.block[tile] < tiles.block_count);
    return tiles.blocks.data() + 64 * size_t{tiles.block[tile]};
}

/// What a tile's layer claims at the pixels from the i-th on, if it has no block.
template <class D>
HWY_INLINE hn::Vec<D> flatLayer(D d, const DepthTiles& tiles, uint32_t tile, size_t i) {
    const float layer = tiles.layer[tile];
    const uint64_t mask = layer > DepthTiles::kOpen ? tiles.layer_mask[tile] : 0;
    return hn::IfThenElse(maskFromBits(d, mask >> i), hn::Set(d, layer), hn::Set(d, DepthTiles::kOpen));
}

/// Brings a tile's base up to its block, once all pixels of the block are covered.
HWY_INLINE void settleBlock(DepthTiles& tiles, uint32_t tile, const float* depths) {
    const F16 d;
    auto least = hn::LoadU(d, depths);
    for (size_t i = hn::Lanes(d); i < 64; i += hn::Lanes(d)) least = hn::Min(least, hn::LoadU(d, depths + i));
    const float farthest = hn::GetLane(hn::MinOfLanes(d, least));
    if (!(farthest > tiles.base[tile])) return;
    tiles.base[tile] = farthest;
    tiles.plane[tile] = DepthTiles::kNone;
}

/// Raises the pixels of a mask, each to its own depth, in a tile that gets a block.
/// @param depthOf  a vector of depths, of the pixels from the i-th on
template <class DepthOf>
HWY_INLINE void raiseBlockTo(DepthTiles& tiles, uint32_t tile, uint64_t mask, const DepthOf& depthOf) {
    const F16 d;
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size());
    const bool layered = tiles.layer[tile] > DepthTiles::kOpen, old_block = blockOf(tiles, tile) != nullptr;
    float* const block = old_block ? blockOf(tiles, tile) : newBlock(tiles, tile);
    auto greatest = hn::Set(d, DepthTiles::kOpen);
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
        const auto old = old_block ? hn::LoadU(d, block + i) : flatLayer(d, tiles, tile, i);
        const auto raised = hn::IfThenElse(maskFromBits(d, mask >> i), hn::Max(old, depthOf(i)), old);
        hn::StoreU(raised, d, block + i);
        greatest = hn::Max(greatest, raised);
    }
    tiles.layer_mask[tile] = mask | (layered ? tiles.layer_mask[tile] : 0);
    tiles.layer[tile] = hn::GetLane(hn::MaxOfLanes(d, greatest));
    if (tiles.layer_mask[tile] == ~uint64_t{0}) settleBlock(tiles, tile, block);
}

/// Raises the pixels of a mask in a tile that gets a block.
HWY_INLINE void raiseBlock(DepthTiles& tiles, uint32_t tile, uint64_t mask, float z) {
    raiseBlockTo(tiles, tile, mask, [&](size_t) HWY_ATTR { return hn::Set(F16(), z); });
}

/// The same by depths in memory.
HWY_INLINE void raiseBlockBy(DepthTiles& tiles, uint32_t tile, uint64_t mask, const float* depths) {
    raiseBlockTo(tiles, tile, mask, [&](size_t i) HWY_ATTR { return hn::LoadU(F16(), depths + i); });
}

/// Covers a whole tile.
HWY_INLINE void coverWhole(DepthTiles& tiles, uint32_t tile, float z, uint32_t plane) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && !std::isnan(z));
    SIGHTLINE_DEBUG_ASSERT(plane == DepthTiles::kNone || plane < tiles.planes.size());
    if (!(z > tiles.base[tile])) return;
    tiles.base[tile] = z;
    tiles.plane[tile] = plane;
    if (tiles.layer[tile] <= z) tiles.layer[tile] = DepthTiles::kOpen;
}

/// Lays two layers together where there is room for one, neither of which says it all: at the farther of their depths,
/// or, where less is lost so, without the farther one. What is lost at a pixel counts as nearness lost, down to the base.
HWY_INLINE void mergeLayers(DepthTiles& tiles, uint32_t tile, uint64_t near_mask, float near, uint64_t far_mask,
                            float far) {
    SIGHTLINE_DEBUG_ASSERT(near >= far);
    SIGHTLINE_DEBUG_ASSERT((far_mask & ~near_mask) != 0);
    // An open pixel is as good as one at infinity, where nearness is 1/w; else it is worse than any.
    const float ground = std::max(tiles.base[tile], far > 0.0f ? 0.0f : DepthTiles::kOpen);
    const float by_merging = (near - far) * static_cast<float>(std::popcount(near_mask));
    const float by_dropping = (far - ground) * static_cast<float>(std::popcount(far_mask & ~near_mask));
    const bool merge = by_merging <= by_dropping;
    tiles.layer[tile] = merge ? far : near;
    tiles.layer_mask[tile] = merge ? near_mask | far_mask : near_mask;
}

/// Covers the pixels of a mask, which is not empty, at one depth; rounding has been taken into it.
///
/// What two layers claim together is what each of them claims, at the farther of their depths.
inline void coverPixels(DepthTiles& tiles, uint32_t tile, uint64_t mask, float z) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && !std::isnan(z));
    SIGHTLINE_DEBUG_ASSERT(mask != 0 || tiles.detail == Detail::kMasked);
    if (!(z > tiles.base[tile])) return;
    const float layer = tiles.layer[tile];
    if (layer == DepthTiles::kOpen) {
        tiles.layer[tile] = z;
        tiles.layer_mask[tile] = mask;
        tiles.block[tile] = DepthTiles::kNone;
        return;
    }
    if (tiles.block[tile] != DepthTiles::kNone) return raiseBlock(tiles, tile, mask, z);
    const uint64_t old = tiles.layer_mask[tile], both = old | mask;
    if (z <= layer) {
        if (!(mask & ~old)) return;  // the old layer says it all
        if (both == ~uint64_t{0}) {
            tiles.base[tile] = z;
            tiles.plane[tile] = DepthTiles::kNone;
            if (z == layer) tiles.layer[tile] = DepthTiles::kOpen;
            return;
        }
    } else {
        if (!(old & ~mask) || both == ~uint64_t{0}) {
            if (both == ~uint64_t{0}) {
                tiles.base[tile] = layer;
                tiles.plane[tile] = DepthTiles::kNone;
            }
            tiles.layer[tile] = z;
            tiles.layer_mask[tile] = mask;
            return;
        }
    }
    if (tiles.detail == Detail::kFull) return raiseBlock(tiles, tile, mask, z);
    if (z > layer) mergeLayers(tiles, tile, mask, z, old, layer);
    else mergeLayers(tiles, tile, old, layer, mask, z);
}

/// Covers the pixels of a mask by a plane, each at its own depth: for tiles that get a block.
inline void coverPixelsByPlane(DepthTiles& tiles, uint32_t tile, uint64_t mask, const BufferPlane& plane,
                               uint32_t column, uint32_t row) {
    SIGHTLINE_DEBUG_ASSERT(tile == row * tiles.stride + column && column < tiles.columns);
    const TilePlane here = planeInTile(plane, column, row);
    raiseBlockTo(tiles, tile, mask, [&](size_t i) HWY_ATTR { return planeDepths(F16(), here, i); });
}

/// The pixels of a tile, within the window, that it does not claim to be in front of a nearness; the base is known
/// not to be.
inline uint64_t openTilePixels(const DepthTiles& tiles, uint32_t tile, uint32_t column, uint32_t row, uint64_t window,
                               float nearness) {
    SIGHTLINE_DEBUG_ASSERT(tile == row * tiles.stride + column && tile < tiles.base.size());
    SIGHTLINE_DEBUG_ASSERT(!(tiles.base[tile] > nearness));
    uint64_t open = window;
    if (tiles.layer[tile] > nearness) {
        if (tiles.block[tile] == DepthTiles::kNone) open &= ~tiles.layer_mask[tile];
        else open &= ~pixelsNearer(tiles.blocks.data() + 64 * size_t{tiles.block[tile]}, nearness);
    }
    if (open && tiles.base[tile] > DepthTiles::kOpen && tiles.plane[tile] != DepthTiles::kNone) {
        alignas(64) float depths[64];
        planeDepths(planeInTile(tiles.planes[tiles.plane[tile]], column, row), depths);
        open &= ~pixelsNearer(depths, nearness);
    }
    return open;
}

/// What a tile claims, pixel by pixel.
HWY_INLINE void claimsOfTile(const DepthTiles& tiles, uint32_t tile, float* claims) {
    const F16 d;
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size());
    const float base = tiles.base[tile];
    const bool planar = base > DepthTiles::kOpen && tiles.plane[tile] != DepthTiles::kNone;
    if (planar)
        planeDepths(planeInTile(tiles.planes[tiles.plane[tile]], tile % tiles.stride, tile / tiles.stride), claims);
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
        auto z = hn::Set(d, base);
        if (planar) z = hn::Max(z, hn::LoadU(d, claims + i));
        if (tiles.layer[tile] > DepthTiles::kOpen) {
            if (tiles.block[tile] != DepthTiles::kNone)
                z = hn::Max(z, hn::LoadU(d, tiles.blocks.data() + 64 * size_t{tiles.block[tile]} + i));
            else
                z = hn::IfThenElse(maskFromBits(d, tiles.layer_mask[tile] >> i),
                                   hn::Max(z, hn::Set(d, tiles.layer[tile])), z);
        }
        hn::StoreU(z, d, claims + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
