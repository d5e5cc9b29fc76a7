// A polygon ready to be drawn into a depth buffer: its edges by height, its plane, its extent.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/project/homogeneous.h"
#include "sightline/studies/hidden/project/screen_polygon.h"
#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

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
};

/// What polygons are prepared for.
struct PolygonTarget {
    uint32_t width = 0, height = 0;  ///< [samples]
    const DepthCodec& codec;
    double offset_factor = 0, offset_units = 0;  ///< DepthCodec::polygonOffset
};

/// Polygons in the order in which they are drawn, and which of them meet each row of tiles.
struct PolygonBatch {
    /// As much of a polygon as it takes to find that it is hidden.
    struct Entry {
        uint32_t polygon;
        uint16_t first, last;  ///< columns of tiles, both included
        DepthKey nearest;      ///< of all its keys
    };
    struct Rejection {
        uint32_t rows = 0;      ///< of tiles that the polygon meets
        uint32_t rejected = 0;  ///< of them, those where it was known to be hidden; counted by several threads
    };

    std::vector<DepthPolygon> polygons;
    std::vector<ScreenPolygon> outlines;
    std::vector<HomogeneousTriangle> clipless;
    std::vector<std::vector<Entry>> rows;       ///< [size: rows of tiles]
    mutable std::vector<Rejection> rejections;  ///< [size: polygons]

    explicit PolygonBatch(uint32_t tile_rows = 0) : rows(tile_rows) {}
    void clear(uint32_t tile_rows);
    /// Takes up a polygon if it may cover a sample.
    void add(const ScreenPolygon& polygon, const PolygonTarget& target);
    void add(const HomogeneousTriangle& triangle, const PolygonTarget& target);

private:
    void put(DepthPolygon& polygon, const PolygonTarget& target);
};

}  // namespace sightline::studies
