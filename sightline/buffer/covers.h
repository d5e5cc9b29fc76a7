// Which planes cover which pixels of a tile: what lies wholly behind them is hidden there, whatever the depths.
// SPDX-License-Identifier: MIT
//
// A cover says: each ray through a pixel of the mask meets a polygon on one of the planes. What a tile once was told
// stays true, so covers may come in any order, and any of them may be forgotten. Their use is in ask/occludee_box.h.
#pragma once

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"

namespace sightline {

/// A plane is taken to be wrong by so much of a polygon's nearness, so that polygons that lie flat beside each other
/// have one plane: half a millimetre at sixteen metres.
constexpr double kFlatEnough = 0x1p-15;

/// Notes that planes, if there are some, cover pixels of a tile between them. Where there is no room, the cover of the
/// fewest pixels goes.
void noteCover(DepthTiles& tiles, uint32_t tile, uint64_t mask, const PlaneSet& planes);

/// One of the last planes, of which a convex polygon is no farther than its error; kNone if there is none.
/// @param x,y,d  the polygon's corners              [size: count]
/// @param error  bound on the error of the polygon's own plane
/// @param first  planes before this one do not count
/// @param most   so many are looked at
uint32_t findPlane(const DepthTiles& tiles, const double* x, const double* y, const double* d, int count, double error,
                   size_t first, size_t most);

/// Of the open pixels of a tile those that no planes cover which the box lies behind.
uint64_t openToBox(const DepthTiles& tiles, uint32_t tile, uint64_t open, const OccludeeBox& box);

/// Whether one plane covers all of a tile.
inline bool hasBasePlane(const DepthTiles& tiles, uint32_t tile) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size());
    return tiles.base[tile] > DepthTiles::kOpen && tiles.plane[tile] != DepthTiles::kNone;
}

/// Whether one plane covers all of a tile, and the box lies behind that.
inline bool isBehindBase(const DepthTiles& tiles, uint32_t tile, const OccludeeBox& box) {
    return hasBasePlane(tiles, tile) && box.isBehind(tiles, tiles.plane[tile]);
}

/// The pixels of a tile that some planes cover.
inline uint64_t coveredByPlanes(const DepthTiles& tiles, uint32_t tile) {
    if (hasBasePlane(tiles, tile)) return ~uint64_t{0};
    SIGHTLINE_DEBUG_ASSERT(tiles.cover_count[tile] <= DepthTiles::kCovers);
    uint64_t all = 0;
    const TileCover* const covers = tiles.covers.data() + DepthTiles::kCovers * size_t{tile};
    for (uint32_t i = 0; i < tiles.cover_count[tile]; ++i) all |= covers[i].mask;
    return all;
}

}  // namespace sightline
