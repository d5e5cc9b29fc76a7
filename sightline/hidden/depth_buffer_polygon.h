// A polygon ready to be drawn into a depth buffer: its edges by height, its plane, its extent.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/hidden/homogeneous.h"
#include "sightline/hidden/screen_polygon.h"

namespace sightline {

struct DepthPolygon {
    static constexpr int32_t kTriangle = -1;

    double x[3], y[3];  ///< of triangles: corners by height, lowest first
    double slope[3];    ///< dx / dy: lowest to highest, lowest to middle, middle to highest
    double doubt = 0;   ///< by less than this, rounding moves where an edge crosses a row
    DepthPlane depth;
    double offset = 0;  ///< DepthCodec::polygonOffset
    uint32_t surface = 0;
    int32_t row_begin = 0, row_end = 0, begin = 0, end = 0;  ///< samples outside of these are not covered
    int32_t outline = kTriangle;  ///< of others: where their outline is, PolygonBatch::outlines or ::clipless
    bool is_clipless = false;
    mutable uint32_t rejected = 0;  ///< rows of tiles where it was known to be hidden; written by several threads
};

/// Polygons in the order in which they are drawn, and which of them meet each row of tiles.
struct PolygonBatch {
    std::vector<DepthPolygon> polygons;
    std::vector<ScreenPolygon> outlines;
    std::vector<HomogeneousTriangle> clipless;
    std::vector<std::vector<uint32_t>> rows;  ///< indices of polygons [size: rows of tiles]

    explicit PolygonBatch(uint32_t tile_rows = 0) : rows(tile_rows) {}
    void clear();
    /// Takes up a polygon if it may cover a sample.
    void add(const ScreenPolygon& polygon, uint32_t width, uint32_t height);
    void add(const HomogeneousTriangle& triangle, uint32_t width, uint32_t height);

private:
    void put(DepthPolygon& polygon);
};

}  // namespace sightline
