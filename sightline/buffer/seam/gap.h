// Bridges over gaps: what lies between two polygons on a line shorter than a given length.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/base/assert.h"
#include "sightline/buffer/polygon.h"

namespace sightline {

/// A convex polygon near a pixel.
struct GapPolygon {
    double x[4], y[4];  ///< corners, counter-clockwise, relative to the pixel's centre  [pixels]
    int count = 0;
    double error = 0;  ///< bound on the corners' error
};

/// A convex region that is closed: where all its edge functions are 0 or more, relative to the pixel's centre.
struct Bridge {
    EdgeFunction edge[4];
    int edges = 0;

    void add(double a, double b, double c) {
        SIGHTLINE_DEBUG_ASSERT(edges < 4);
        edge[edges++] = {a, b, c};
    }
};

/// Finds the bridges between polygons that reach into the pixel.
///
/// Every point of a bridge lies on a line that is no longer than the gap, but for the errors of the corners, from one
/// polygon to another: between two sides that face each other, or between a corner and a side. Where gaps meet, the
/// line may lead from a polygon, or from a gap between two, to a gap between two others. So no wider gap is closed, nor
/// anything beside a silhouette.
///
/// @param most  work cap: room in `out`
/// @returns how many there are
int makeBridges(const GapPolygon* polygons, int count, double gap, Bridge* out, int most);

}  // namespace sightline
