// Scan conversion that is exact for the vertices given: which samples of a row a polygon covers.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/glm.hpp>

namespace sightline::studies {

/// The sign of the area of the triangle (a, b, c): +1 counter-clockwise, -1 clockwise, 0 exactly on a line.
/// Exact for all finite inputs whose products neither overflow nor underflow.
int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// The first sample of a row, at (i + 0.5, row + 0.5), that lies on the edge or to the right of it; exact, and
/// the same for (a, b) and (b, a). Clamped to [0, width].
/// @param a, b  ends of an edge that crosses the row, at different heights
inline int32_t firstSampleRightOf(glm::dvec2 a, glm::dvec2 b, int32_t row, int32_t width) {
    if (a.y > b.y) std::swap(a, b);
    const double y = row + 0.5;
    const double x = a.x + (y - a.y) * ((b.x - a.x) / (b.y - a.y)) - 0.5;
    if (!(x > -1)) return 0;
    if (x > width) return width;
    // The nearest whole number: adding 1.5 * 2^52 rounds to one, and without SSE4 std::rint() is a call.
    constexpr double kWhole = 0x1.8p52;
    const double nearest = (x + kWhole) - kWhole;
    // Rounding moved x by less than ten units in the last place of the ends; where that could decide
    // between two samples, the exact predicate does.
    const double doubt = 0x1p-47 * (std::abs(a.x) + std::abs(b.x) + 1.0);
    double first = nearest < x ? nearest + 1 : nearest;
    if (std::abs(x - nearest) <= doubt) first = orientation(a, b, {nearest + 0.5, y}) <= 0 ? nearest : nearest + 1;
    return first < 0 ? 0 : first > width ? width : static_cast<int32_t>(first);
}

/// Calls fill(row, begin, end) for the samples that a polygon covers: sample i of a row lies at
/// (i + 0.5, row + 0.5), rows grow upward. Either winding. Left and top edges belong to the polygon,
/// right and bottom ones do not: polygons that share edges and tile a region cover each sample once.
/// @param points  [size: <= 10]
template <class Fill>
void scanPolygon(std::span<const glm::dvec2> points, int32_t row_begin, int32_t row_end, int32_t width, Fill&& fill) {
    double low = points[0].y, high = low;
    for (const glm::dvec2& point : points) {
        low = point.y < low ? point.y : low;
        high = point.y > high ? point.y : high;
    }
    if (!(high > row_begin && low < row_end)) return;
    const double first = std::floor(low - 0.5), last = std::floor(high - 0.5);
    if (first > row_begin) row_begin = static_cast<int32_t>(first);
    if (last + 1 < row_end) row_end = static_cast<int32_t>(last) + 1;
    for (int32_t row = row_begin; row < row_end; ++row) {
        const double y = row + 0.5;
        int32_t crossings[10];
        int count = 0;
        for (size_t i = 0; i < points.size(); ++i) {
            const glm::dvec2& a = points[i];
            const glm::dvec2& b = points[i + 1 == points.size() ? 0 : i + 1];
            if ((a.y < y) == (b.y < y)) continue;
            int32_t at = firstSampleRightOf(a, b, row, width);
            int slot = count++;
            for (; slot > 0 && crossings[slot - 1] > at; --slot) crossings[slot] = crossings[slot - 1];
            crossings[slot] = at;
        }
        for (int i = 0; i + 1 < count; i += 2)
            if (crossings[i] < crossings[i + 1]) fill(row, crossings[i], crossings[i + 1]);
    }
}

}  // namespace sightline::studies
