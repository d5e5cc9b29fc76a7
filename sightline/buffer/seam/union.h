// Whether convex polygons leave nothing of a pixel: the pixel's square minus each of them in turn.
// SPDX-License-Identifier: MIT
//
// Kevin Weiler, Peter Atherton. Hidden Surface Removal Using Polygon Area Sorting. 1977.
#pragma once

#include <cstdint>

#include "sightline/buffer/polygon.h"
#include "sightline/buffer/seam/gap.h"

namespace sightline {

/// A polygon that may cover a part of the pixel.
struct UnionPiece {
    const RasterPolygon* polygon = nullptr;  ///< complete: its edge functions bound it
    uint32_t shared = 0;  ///< bit per edge that another drawn polygon has the other way round, exactly
    double farthest = 0;  ///< no point of it in the pixel is farther; nor within the gap around it
};

/// What the union of polygons is to a pixel.
struct PixelUnion {
    double nearness = 0;   ///< the least `farthest` of the pieces that were needed; -infinity if something is left
    bool whole = true;     ///< no work cap (regions) was met; else something may seem to be left
    bool bridged = false;  ///< gaps had to be closed
    int used = 0;          ///< pieces that took something away
    int last = -1;         ///< the last of them
    uint32_t took = 0;     ///< bit per piece of them  [limit: 32 pieces]
};

/// Subtracts the pieces from the square of the pixel whose centre is given, in their order: away from the eye.
///
/// Certain: an edge that is not shared is moved inward by more than rounding; at a shared one both sides are covered
/// within rounding, and the two polygons have the same edge function but for its sign, so that nothing is lost between.
///
/// @param gap   what is left and lies between pieces on lines shorter than that counts as covered  [pixels]; 0: nothing
/// @param near  per piece its corners; not read if gap is 0
PixelUnion subtractFromPixel(double x, double y, const UnionPiece* pieces, int count, double gap = 0,
                             const GapPolygon* near = nullptr);

}  // namespace sightline
