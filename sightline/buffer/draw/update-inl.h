// Which blocks are open, and how the tiles of a block take in what a part covers of it.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_UPDATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_UPDATE_INL_H
#undef SIGHTLINE_BUFFER_DRAW_UPDATE_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_UPDATE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/buffer/covers.h"
#include "sightline/buffer/draw/cover-inl.h"
#include "sightline/buffer/draw/depth-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The first and the last of some blocks of a row that are open to a nearness.
struct OpenBlocks {
    int first, last;  ///< last < first: none
};

inline OpenBlocks openBlocks(const DepthTiles& tiles, int row, int column0, int column1, float nearest) {
    const F f;
    const int tile0 = 4 * column0, tile1 = std::min(4 * column1 + 3, static_cast<int>(tiles.columns) - 1);
    OpenBlocks out{column1 + 1, -1};
    for (int r = 2 * row; r < std::min(2 * row + 2, static_cast<int>(tiles.rows)); ++r) {
        const float* base = tiles.base.data() + static_cast<size_t>(r) * tiles.stride;
        for (int at = tile0; at <= tile1; at += static_cast<int>(hn::Lanes(f))) {
            uint32_t bits =
                static_cast<uint32_t>(bitsFromMask(f, hn::Lt(hn::LoadU(f, base + at), hn::Set(f, nearest))));
            if (tile1 - at < 31) bits &= (2u << (tile1 - at)) - 1;
            if (bits == 0) continue;
            out.first = std::min(out.first, (at + std::countr_zero(bits)) / 4);
            out.last = std::max(out.last, (at + 31 - std::countl_zero(bits)) / 4);
        }
    }
    return out;
}

/// The tiles of a block that are in the image and open to a nearness, as bits.
inline uint32_t openTiles(const DepthTiles& tiles, int column, int row, float nearest) {
    const hn::CappedTag<float, 4> f;
    uint32_t open = 0;
    for (int r = 0; r < 2 && 2 * row + r < static_cast<int>(tiles.rows); ++r) {
        const float* base = tiles.base.data() + static_cast<size_t>(2 * row + r) * tiles.stride + 4 * column;
        for (size_t t = 0; t < 4; t += hn::Lanes(f))
            open |= static_cast<uint32_t>(bitsFromMask(f, hn::Lt(hn::LoadU(f, base + t), hn::Set(f, nearest))))
                    << (4 * static_cast<size_t>(r) + t);
    }
    const int columns = static_cast<int>(tiles.columns) - 4 * column;
    return columns >= 4 ? open : open & ((1u << columns) - 1) * 0x11u;
}

/// Whether a block that a rectangle of the image meets is open to a nearness.
inline bool isRectOpen(const DepthTiles& tiles, float x0, float y0, float x1, float y1, float nearest) {
    const int column0 = static_cast<int>(std::max(x0, 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(x1, static_cast<float>(tiles.width - 1))) / kBlockWidth,
              row0 = static_cast<int>(std::max(y0, 0.0f)) / kBlockHeight,
              row1 = static_cast<int>(std::min(y1, static_cast<float>(tiles.height - 1))) / kBlockHeight;
    for (int row = row0; row <= row1; ++row)
        if (openBlocks(tiles, row, column0, column1, nearest).last >= 0) return true;
    return false;
}

/// Covers pixels of a tile, where it pays each at its own depth: where one plane alone slopes through the tile.
inline void coverPart(DepthTiles& tiles, uint32_t tile, uint64_t mask, float z, const PlaneSet& planes) {
    noteCover(tiles, tile, mask, planes);
    const uint32_t plane = planes.alone();
    if (tiles.detail == Detail::kFull && plane != DepthTiles::kNone) {
        const BufferPlane& slope = tiles.planes[plane];
        if (8.0 * (std::abs(slope.dx) + std::abs(slope.dy)) > 0x1p-9 * std::abs(z))
            return coverPixelsByPlane(tiles, tile, mask, slope, tile % tiles.stride, tile / tiles.stride);
    }
    coverPixels(tiles, tile, mask, z);
}

/// Names a cluster as one of those that share pixels of a tile.
inline void addSeam(DepthTiles& tiles, uint32_t tile, uint64_t mask, uint32_t source, float nearest) {
    uint32_t& last = tiles.seams[tile];
    if (last == DepthTiles::kNone) tiles.seam_mask[tile] = tiles.tried[tile] = 0;
    if (last == DepthTiles::kNone || tiles.chunks[last].count == SeamChunk::kMost) {
        const uint32_t before = last == DepthTiles::kNone ? 0 : tiles.chunks[last].before + SeamChunk::kMost;
        SeamChunk& chunk = tiles.chunks.emplace_back();
        chunk.next = last;
        chunk.before = before;
        last = static_cast<uint32_t>(tiles.chunks.size() - 1);
    }
    SeamChunk& chunk = tiles.chunks[last];
    chunk.mask[chunk.count] = mask;
    chunk.source[chunk.count] = source;
    chunk.nearest[chunk.count++] = nearest;
    tiles.lid_mask[tile] = 0;
    tiles.seam_mask[tile] |= mask;
    tiles.tried[tile] &= ~mask;
}

/// Pixels of a mask that a tile does not already claim at the nearness or nearer.
inline uint64_t notYetNearer(const DepthTiles& tiles, uint32_t tile, uint64_t mask, float nearness) {
    if (tiles.base[tile] >= nearness) return 0;
    if (!(tiles.layer[tile] >= nearness)) return mask;
    if (tiles.block[tile] == DepthTiles::kNone) return mask & ~tiles.layer_mask[tile];
    return mask & ~pixelsNearer(tiles.blocks.data() + 64 * size_t{tiles.block[tile]}, nearness);
}

/// The plane of a group among those of the tiles.
inline uint32_t planeOf(DepthTiles& tiles, GroupDepth& group, float farthest) {
    if (group.index == DepthTiles::kNone) {
        group.index = static_cast<uint32_t>(tiles.planes.size());
        tiles.planes.push_back({double{group.c}, double{group.a}, double{group.b}, farthest, 0});
    }
    return group.index;
}

/// Takes what a part covers of a block into its tiles.
/// @param nearest, farthest  nothing of the part is nearer or farther
/// @param seam               (tile, mask): pixels that edges touch and that are not claimed as near
template <class Seam>
void updateBlock(DepthTiles& tiles, int column, int row, const uint32_t* covered, const uint32_t* touched,
                 GroupDepth* groups, int count, float nearest, float farthest, Seam seam) {
    alignas(64) uint64_t cover[kBlockTiles], touch[kBlockTiles];
    TileDepths depths;
    tilesOf(covered, cover);
    tilesOf(touched, touch);
    depthOfTiles(column, row, groups, count, depths);
    for (uint32_t left = openTiles(tiles, column, row, nearest); left != 0; left &= left - 1) {
        const int t = std::countr_zero(left);
        const uint32_t tile =
            static_cast<uint32_t>(2 * row + t / 4) * tiles.stride + static_cast<uint32_t>(4 * column + t % 4);
        const float z = std::max(depths.z[t], farthest);
        if (cover[t] != 0 && depths.z[t] < std::numeric_limits<float>::infinity() && z > tiles.base[tile]) {
            const auto plane = [&](float group) { return planeOf(tiles, groups[static_cast<int>(group)], farthest); };
            PlaneSet planes;
            if (depths.single >> t & 1) planes = PlaneSet(plane(depths.last[t]));
            else if (depths.two >> t & 1) planes = PlaneSet(plane(depths.first[t]), plane(depths.last[t]));
            if (cover[t] != ~uint64_t{0}) {
                coverPart(tiles, tile, cover[t], z, planes);
            } else {
                if (planes.alone() == DepthTiles::kNone) noteCover(tiles, tile, cover[t], planes);
                coverWhole(tiles, tile, z, planes.alone());
            }
        }
        if (touch[t] == 0) continue;
        if (const uint64_t mask = notYetNearer(tiles, tile, touch[t], nearest)) seam(tile, mask);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
