// What seams are resolved by: the polygons of drawn clusters that left them, made when asked for, and what they share.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>

#include "sightline/base/assert.h"
#include "sightline/buffer/tiles.h"

namespace sightline {

/// One polygon of a drawn cluster, in DepthTiles::polygons; made at the first call.
/// @param count  gets 0 to 2: none if it is turned away, two triangles of a quadrangle that is not flat
void seamPolygon(DepthTiles& tiles, uint32_t drawn, uint32_t polygon, uint32_t& first, uint32_t& count);

/// The plane of a seam polygon, in DepthTiles::planes; made at the first call.
uint32_t seamPlane(DepthTiles& tiles, uint32_t polygon);

/// Where the boxes of a drawn cluster's own polygons begin in DepthTiles::boxes; made at the first call.
/// @param count  gets how many polygons there are
uint32_t seamBoxes(DepthTiles& tiles, uint32_t drawn, uint32_t& count);

/// A rectangle of the buffer, and how wide and high is what matters there  [pixels].
struct SeamRect {
    float x0, y0, x1, y1;
    float least = -1.0f;
};

/// Which of 64 polygons may touch a rectangle, and are large enough.
/// @param boxes  of the first of them, as in DepthTiles::boxes
/// @param count  how many there are
uint64_t polygonsIn(const float* boxes, uint32_t count, const SeamRect& rect);

/// Calls `look` with each entry of a tile, the last first.
template <class Look>
void forSeamEntries(const DepthTiles& tiles, uint32_t tile, Look look) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.seams.size());
    for (uint32_t at = tiles.seams[tile]; at != DepthTiles::kNone; at = tiles.chunks[at].next)
        for (uint32_t i = tiles.chunks[at].count; i-- > 0;) look(tiles.chunks[at].entry(i));
}

/// Calls `take` with the index of each polygon of an entry that may touch the rectangle, once it is made.
template <class Take>
void forSeamPolygons(DepthTiles& tiles, const SeamEntry& entry, const SeamRect& rect, Take take) {
    SIGHTLINE_DEBUG_ASSERT(entry.drawn() < tiles.drawn.size());
    SIGHTLINE_DEBUG_ASSERT(rect.x0 <= rect.x1 && rect.y0 <= rect.y1);
    uint32_t first, count;
    if (entry.polygon() != SeamEntry::kAllPolygons) {
        seamPolygon(tiles, entry.drawn(), entry.polygon(), first, count);
        for (uint32_t i = first; i < first + count; ++i) take(i);
        return;
    }
    uint32_t all;
    const uint32_t boxes = seamBoxes(tiles, entry.drawn(), all);
    for (uint32_t p = 0; p < all; p += 64)
        for (uint64_t in = polygonsIn(tiles.boxes.data() + boxes + 4 * size_t{p}, std::min(64u, all - p), rect); in;
             in &= in - 1) {
            seamPolygon(tiles, entry.drawn(), p + static_cast<uint32_t>(std::countr_zero(in)), first, count);
            for (uint32_t i = first; i < first + count; ++i) take(i);
        }
}

/// Fills in the keys of a seam polygon's sides.
void setSideKeys(const DepthTiles& tiles, SeamPolygon& polygon);

/// Whether two sides are the same edge run through in opposite directions: exactly, in world space.
bool areOpposite(const DepthTiles& tiles, const SeamPolygon& a, int side_a, const SeamPolygon& b, int side_b);

/// Finds a side that two polygons share: the same edge of the world, exactly, run through in opposite directions.
bool findSharedSide(const DepthTiles& tiles, const SeamPolygon& a, const SeamPolygon& b, int& side_a, int& side_b);

/// What the masks of a tile's entries tell, without a look at a polygon.
struct SeamMasks {
    uint64_t open = 0;  ///< pixels that surely stay open
    uint64_t few = 0;   ///< pixels that no more than two entries touch
};

/// Looks at the entries that may lie in front of a nearness. Remembers which pixels of the tile are open.
/// @param pixels  which pixels matter
SeamMasks lookAtSeams(DepthTiles& tiles, uint32_t tile, uint64_t pixels, float wanted);

}  // namespace sightline
