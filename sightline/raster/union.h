// Whether convex polygons leave nothing of a pixel: the pixel's square minus each of them in turn.
// SPDX-License-Identifier: MIT
//
// Kevin Weiler, Peter Atherton. Hidden Surface Removal Using Polygon Area Sorting. 1977.
#pragma once

#include <cstdint>

#include "sightline/raster/polygon.h"

namespace sightline {

/// A polygon that may cover a part of the pixel.
struct UnionPiece {
    const RasterPolygon* polygon = nullptr;  ///< complete: its edge functions bound it
    uint32_t shared = 0;  ///< bit per edge that another drawn polygon has the other way round, exactly
    double farthest = 0;  ///< no point of it in the pixel is farther
};

/// Subtracts the pieces from the square of the pixel whose centre is given, in their order.
///
/// Certain: an edge that is not shared is moved inward by more than rounding; at a shared one both sides are covered
/// within rounding, and the two polygons have the same edge function but for its sign, so that nothing is lost between.
///
/// @param whole  cleared if the work cap (regions) is met
/// @returns the least `farthest` of the pieces that were needed; -infinity if something is left, or if the cap is met
double subtractFromPixel(double x, double y, const UnionPiece* pieces, int count, bool& whole);

}  // namespace sightline
