// A polygon ready to be drawn into a depth buffer: its edges by height, its plane, its extent.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer_polygon.h"

#include <algorithm>
#include <cmath>

namespace sightline::studies {
namespace {

/// A number of samples, kept within the image; NaN gives 0.
int32_t within(double value, uint32_t limit) {
    return value > 0 ? value < limit ? static_cast<int32_t>(value) : static_cast<int32_t>(limit) : 0;
}

}  // namespace

void PolygonBatch::clear(uint32_t tile_rows) {
    polygons.clear();
    outlines.clear();
    clipless.clear();
    rejections.clear();
    rows.resize(tile_rows);
    for (std::vector<Entry>& row : rows) row.clear();
}

void PolygonBatch::put(DepthPolygon& polygon, const PolygonTarget& target) {
    polygon.offset = target.codec.polygonOffset(polygon.depth, target.offset_factor, target.offset_units);
    const Entry entry{static_cast<uint32_t>(polygons.size()), static_cast<uint16_t>(polygon.begin / 8),
                      static_cast<uint16_t>((polygon.end - 1) / 8),
                      target.codec.encode(polygon.depth.high, polygon.offset)};
    const int32_t first = polygon.row_begin / 8, last = (polygon.row_end - 1) / 8;
    for (int32_t row = first; row <= last; ++row) rows[static_cast<size_t>(row)].push_back(entry);
    rejections.push_back({static_cast<uint32_t>(last - first + 1), 0});
    polygons.push_back(polygon);
}

void PolygonBatch::add(const ScreenPolygon& source, const PolygonTarget& target) {
    const uint32_t width = target.width, height = target.height;
    glm::dvec2 low = source.points[0], high = low;
    for (const glm::dvec2& point : source.outline()) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    // Sample i of row j lies at (i + 0.5, j + 0.5): rows above low and up to high are met.
    DepthPolygon polygon;
    polygon.row_begin = within(std::floor(low.y - 0.5) + 1, height);
    polygon.row_end = within(std::floor(high.y - 0.5) + 1, height);
    polygon.begin = within(std::floor(low.x - 0.5), width);
    polygon.end = within(std::floor(high.x + 0.5), width);
    if (polygon.row_begin >= polygon.row_end || polygon.begin >= polygon.end) return;
    polygon.depth = source.depth;
    polygon.surface = source.surface;
    if (source.count != 3) {
        polygon.outline = static_cast<int32_t>(outlines.size());
        outlines.push_back(source);
        return put(polygon, target);
    }
    int order[3] = {0, 1, 2};
    const auto sortPair = [&](int i, int j) {
        if (source.points[order[j]].y < source.points[order[i]].y) std::swap(order[i], order[j]);
    };
    sortPair(0, 1);
    sortPair(1, 2);
    sortPair(0, 1);
    for (int i = 0; i < 3; ++i) {
        polygon.x[i] = source.points[order[i]].x;
        polygon.y[i] = source.points[order[i]].y;
    }
    const auto slope = [&](int a, int b) { return (polygon.x[b] - polygon.x[a]) / (polygon.y[b] - polygon.y[a]); };
    polygon.slope[0] = slope(0, 2);
    polygon.slope[1] = slope(0, 1);
    polygon.slope[2] = slope(1, 2);
    // As in firstSampleRightOf(): less than ten units in the last place of the ends.
    polygon.doubt = 0x1p-47 * (2 * std::max(std::abs(low.x), std::abs(high.x)) + 1.0);
    put(polygon, target);
}

void PolygonBatch::add(const HomogeneousTriangle& triangle, const PolygonTarget& target) {
    DepthPolygon polygon;
    polygon.row_begin = std::max(triangle.row_begin, 0);
    polygon.row_end = std::min(triangle.row_end, static_cast<int32_t>(target.height));
    polygon.begin = std::max(triangle.begin, 0);
    polygon.end = std::min(triangle.end, static_cast<int32_t>(target.width));
    if (polygon.row_begin >= polygon.row_end || polygon.begin >= polygon.end) return;
    polygon.depth = triangle.depth;
    polygon.surface = triangle.surface;
    polygon.outline = static_cast<int32_t>(clipless.size());
    polygon.is_clipless = true;
    clipless.push_back(triangle);
    put(polygon, target);
}

}  // namespace sightline::studies
