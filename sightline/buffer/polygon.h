// A projected occluder polygon ready for scan conversion: edge functions, depth plane, pixel bounds.
// SPDX-License-Identifier: MIT
//
// Juan Pineda. A Parallel Algorithm for Polygon Rasterization. 1988.
// Tomas Akenine-Moller, Timo Aila. Conservative and Tiled Rasterization Using a Modified Triangle Set-Up. 2005.
#pragma once

#include <cstdint>

namespace sightline {

/// Edge functions are scaled so that |a| + |b| = 1: a pixel square then reaches exactly 1/2 to either side of
/// its centre's value, and a tile of 8x8 pixels reaches 4.
struct EdgeFunction {
    double a = 0, b = 0, c = 0;
    double at(double x, double y) const { return a * x + b * y + c; }
};

/// What the tile loop needs of one polygon.
struct RasterPolygon {
    EdgeFunction edge[4];
    int edges = 0;
    bool complete = false;  ///< edge i is the side from corner i to the next, for all of them, and bounds the inside
    double d0 = 0, dx = 0, dy = 0;  ///< nearness = d0 + dx x + dy y, where `planar`
    bool planar = false;
    float farthest = 0, nearest = 0;           ///< least and greatest nearness of the corners, rounded outward
    float depth_error = 0;                     ///< bound on the error of the plane, inside the polygon
    float slack = 0;                           ///< bound on the error of an edge function in float  [pixels]
    double error = 0;                          ///< bound on the error of an edge function in double [pixels]
    int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< pixels that it may touch, inclusive, inside the buffer
};

/// Makes the edge functions and the depth plane of a convex polygon.
///
/// @param x,y,d   corners, counter-clockwise [pixels, pixels, nearness]  [size: count]
/// @param count   3 or 4
/// @param position_error  bound on the corners' error                    [pixels]
/// @param depth_error     bound on the error of d
/// Returns false if the polygon misses the buffer or its corners are too far away to be exact.
bool makeRasterPolygon(const double* x, const double* y, const double* d, int count, double position_error,
                       double depth_error, uint32_t width, uint32_t height, RasterPolygon& out);

}  // namespace sightline
