// A convex polygon as something that may be hidden: every pixel that it may touch, with its nearest depth there.
// SPDX-License-Identifier: MIT
//
// Tomas Akenine-Moller, Timo Aila. Conservative and Tiled Rasterization Using a Modified Triangle Set-Up. 2005.
#pragma once

#include <cstdint>
#include <limits>

#include "sightline/buffer/tiles.h"

namespace sightline {

/// Whether something can be seen in front of what the tiles hold.
enum class Sight : uint8_t {
    kVisible,   ///< it may be
    kOccluded,  ///< it is in the view, and surely hidden all over
    kOutside,   ///< it surely misses the buffer, and with it the widened viewport
};

/// The image of a convex polygon, made larger and nearer by more than rounding could have made it smaller and farther.
///
/// Each edge function is shifted until no corner lies outside, and the depth plane until no corner lies in front of it:
/// so they bound the image whatever their direction is, of slivers and of quadrangles that are not quite flat, too.
struct OccludeePolygon {
    static constexpr int kMaxEdges = 4, kMaxCorners = 64;

    double a[kMaxEdges] = {}, b[kMaxEdges] = {}, c[kMaxEdges] = {};  ///< a x + b y + c >= 0 inside; |a| + |b| = 1
    int edges = 0;
    float slack = 0;                ///< bound on the error of an edge function  [pixels]
    double d0 = 0, dx = 0, dy = 0;  ///< no point at (x, y) is nearer than d0 + dx x + dy y
    float depth_error = 0;          ///< bound on the error of that
    PixelRect rect;                 ///< the pixels that it may touch, and the nearest of all its depths
};

/// Makes it.
/// @param x,y,d  corners in order, either way round  [pixels, pixels, nearness]  [size: count]
/// @param count  3 to kMaxCorners; of more than kMaxEdges sides the longest bound it
/// @param position_error  bound on the corners' error                           [pixels]
/// @param depth_error     bound on the error of d
/// @returns kOutside; kVisible if it cannot be bounded, for a corner is not a number; else kOccluded, and `out` is made
Sight makeOccludeePolygon(const double* x, const double* y, const double* d, int count, double position_error,
                          double depth_error, uint32_t width, uint32_t height, OccludeePolygon& out);

/// The pixels of one tile that it may touch, bit 8 * row + column, and how near it may be in each.
/// @param column,row  of the tile; it meets `polygon.rect`
/// @param nearest     written for all 64 pixels
uint64_t occludeePixels(const OccludeePolygon& polygon, int32_t column, int32_t row, float (&nearest)[64]);

/// What the tiles are to an occludee as long as no seam is resolved.
enum class Cover : uint8_t {
    kHidden,     ///< surely hidden
    kOpen,       ///< a pixel is open whatever the seams are
    kUndecided,  ///< seams decide
    kOutside,    ///< it touches no pixel of the buffer
};

/// Looks at a polygon without resolving anything: its rectangle first, then rows of tiles, then tile by tile; ends with
/// the first pixel that is open for good.
/// @param box  that holds the polygon, if one is known: then planes hide it, too
Cover lookAt(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box = nullptr);

/// Whether the tiles surely hide it. Resolves one seam pixel after another, and ends with the first that stays open.
bool isPolygonHidden(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box = nullptr);

/// The second half of isPolygonHidden(), for a polygon that lookAt() left undecided.
bool resolveHidden(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box = nullptr);

}  // namespace sightline
