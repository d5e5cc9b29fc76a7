// Scan conversion without clipping: edge functions in homogeneous space, for any signs of w.
// SPDX-License-Identifier: MIT
//
// Marc Olano, Trey Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997.
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/project/cut.h"
#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

/// The sign of dot(cross(a, b), c), which is that of the determinant with rows a, b, c: +1, -1, or 0 if the three lie in
/// a plane with the origin. Exact for all finite inputs whose products neither overflow nor underflow.
int tripleProductSign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// Where samples lie: sample i of row j at (x / w, y / w) = scale * (i, j) + start.
struct SamplePlaces {
    glm::dvec2 scale{1.0}, start{0.0};

    double x(int32_t sample) const { return scale.x * sample + start.x; }
    double y(int32_t row) const { return scale.y * row + start.y; }
};

/// A triangle as it came out of the projection, not divided by w, and not clipped.
///
/// An edge function is a row of the adjugate of the matrix of (x, y, w): at a place of the image, (x, y, 1), it is the
/// corner's share in the point seen there, over w. So where all three are positive, w is, and no more needs to be said
/// about the eye's plane. The near and the far plane are edges like others.
struct HomogeneousTriangle {
    glm::dvec3 corners[3];  ///< (x, y, w), counter-clockwise as seen
    glm::dvec3 edges[3];    ///< edge k, opposite of corner k: dot(edge, (x, y, 1)) >= 0 inside
    int slopes[3];          ///< the exact sign of a function's change along a row
    double doubt[3];        ///< by how much rounding can have moved its value at any sample
    ScreenCut near_cut, far_cut;
    bool has_near = false, has_far = false;                  ///< whether a corner lies beyond
    int32_t row_begin = 0, row_end = 0, begin = 0, end = 0;  ///< samples outside of these are not touched
    SamplePlaces places;
    DepthPlane depth;      ///< as ScreenPolygon::depth
    uint32_t surface = 0;  ///< DrawList's number

    /// Exact for the corners given and the places of samples; a sample on an edge belongs to one of the two sides, the
    /// same way as in scanPolygon().
    bool insideEdge(int k, double x, double y) const {
        const double value = edges[k].x * x + (edges[k].y * y + edges[k].z);
        if (value > doubt[k]) return true;
        if (value < -doubt[k]) return false;
        return insideEdgeExactly(k, x, y);
    }
    bool insideEdgeExactly(int k, double x, double y) const;
};

/// Makes the edges of a triangle. False if nothing can be seen of it: no area, or corners that are not finite.
/// @param corners  in clip space, but z is the distance from the near plane, z + w; either winding
/// @param grid     whose samples the triangle will be scanned for: rows as in SampleGrid
bool makeHomogeneous(const glm::dvec4 (&corners)[3], const SamplePlaces& places, const SampleGrid& grid,
                     HomogeneousTriangle& out);

/// Calls fill(row, begin, end) for the samples that a triangle covers, as scanPolygon() does. Triangles that share
/// edges cover each sample once; of what a clipped triangle covers, they differ only in samples that lie, but
/// for the rounding of clipping, on an edge.
template <class Fill>
void scanHomogeneous(const HomogeneousTriangle& triangle, int32_t row_begin, int32_t row_end, int32_t width,
                     Fill&& fill) {
    row_begin = std::max(row_begin, triangle.row_begin);
    row_end = std::min(row_end, triangle.row_end);
    for (int32_t row = row_begin; row < row_end; ++row) {
        int32_t begin = std::max(triangle.begin, 0), end = std::min(triangle.end, width);
        const double y = triangle.places.y(row);
        for (int k = 0; k < 3 && begin < end; ++k) {
            const auto inside = [&](int32_t i) { return triangle.insideEdge(k, triangle.places.x(i), y); };
            const glm::dvec3& edge = triangle.edges[k];
            const int slope = triangle.slopes[k];
            if (slope == 0) {
                if (!inside(begin)) end = begin;
                continue;
            }
            // The last sample before the edge: guessed by division, settled by the same function as everywhere.
            const double x = -(edge.y * y + edge.z) / edge.x;
            const double guess = std::floor((x - triangle.places.start.x) / triangle.places.scale.x);
            int32_t last = guess > begin - 1 ? guess < end - 1 ? static_cast<int32_t>(guess) : end - 1 : begin - 1;
            while (last >= begin && inside(last) == (slope > 0)) --last;
            while (last < end - 1 && inside(last + 1) != (slope > 0)) ++last;
            (slope > 0 ? begin : end) = last + 1;
        }
        if (triangle.has_near) triangle.near_cut.narrow(row, begin, end);
        if (triangle.has_far) triangle.far_cut.narrow(row, begin, end);
        if (begin < end) fill(row, begin, end);
    }
}

}  // namespace sightline::studies
