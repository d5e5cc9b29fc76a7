// A projected occluder polygon ready for scan conversion: edge functions, depth plane, pixel bounds.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/polygon.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kFarthestCorner = 0x1p32;  // [pixels]: beyond, a double's step shows in an edge function
constexpr double kShortestEdge = 0x1p-10;   // [pixels]: shorter edges have no direction to rely on
constexpr double kLeastHeight = 0.125;      // [pixels]: a triangle that covers a pixel has area / perimeter above it
constexpr double kEvaluation = 0x1p-14;     // [pixels]: bound on the error of an edge function in float

EdgeFunction makeEdge(double x0, double y0, double x1, double y1, double length) {
    SIGHTLINE_DEBUG_ASSERT(length > 0);
    EdgeFunction e;
    const double scale = 1.0 / length;
    e.a = (y0 - y1) * scale;
    e.b = (x1 - x0) * scale;
    // Anchored at the end nearer to the buffer, so that a far corner's magnitude does not enter.
    // Chosen without regard to the direction: the same edge the other way round has the same function, negated.
    const double far0 = std::abs(x0) + std::abs(y0), far1 = std::abs(x1) + std::abs(y1);
    const bool first = far0 != far1 ? far0 < far1 : x0 != x1 ? x0 < x1 : y0 < y1;
    e.c = -(e.a * (first ? x0 : x1) + e.b * (first ? y0 : y1));
    return e;
}

/// The plane through three corners.
void makePlane(const double* x, const double* y, const double* d, double area2, int c, RasterPolygon& out) {
    SIGHTLINE_DEBUG_ASSERT((c == 2 || c == 3) && area2 > 0);
    const double ux = x[c - 1] - x[0], uy = y[c - 1] - y[0], ud = d[c - 1] - d[0];
    const double vx = x[c] - x[0], vy = y[c] - y[0], vd = d[c] - d[0];
    const double scale = 1.0 / area2;
    out.dx = (ud * vy - vd * uy) * scale;
    out.dy = (vd * ux - ud * vx) * scale;
    out.d0 = d[0] - out.dx * x[0] - out.dy * y[0];
    out.planar = std::isfinite(out.d0) && std::isfinite(out.dx) && std::isfinite(out.dy);
}

/// For a sliver, of which not even the winding is certain: the band around its longest side.
void makeBand(const double* x, const double* y, int count, double area2, double slack, RasterPolygon& out) {
    out.complete = false;
    out.edges = 0;
    double longest = kShortestEdge;
    int at = -1;
    for (int i = 0; i < count; ++i) {
        const int j = i + 1 < count ? i + 1 : 0;
        const double length = std::abs(x[j] - x[i]) + std::abs(y[j] - y[i]);
        if (length < longest) continue;
        longest = length;
        at = i;
    }
    if (at < 0) return;
    const int next = at + 1 < count ? at + 1 : 0;
    const EdgeFunction e = makeEdge(x[at], y[at], x[next], y[next], longest);
    const double reach = 8.0 * slack + area2 / longest;
    out.edge[out.edges++] = {e.a, e.b, e.c + reach};
    out.edge[out.edges++] = {-e.a, -e.b, -e.c + reach};
}

}  // namespace

bool makeRasterPolygon(const double* x, const double* y, const double* d, int count, double position_error,
                       double depth_error, uint32_t width, uint32_t height, RasterPolygon& out) {
    SIGHTLINE_DEBUG_ASSERT(count == 3 || count == 4);
    SIGHTLINE_DEBUG_ASSERT(position_error >= 0 && depth_error >= 0);
    SIGHTLINE_DEBUG_ASSERT(width > 0 && height > 0);
    const double slack = position_error + kEvaluation;
    double x_min = x[0], x_max = x[0], y_min = y[0], y_max = y[0], d_min = d[0], d_max = d[0];
    for (int i = 1; i < count; ++i) {
        x_min = std::min(x_min, x[i]);
        x_max = std::max(x_max, x[i]);
        y_min = std::min(y_min, y[i]);
        y_max = std::max(y_max, y[i]);
        d_min = std::min(d_min, d[i]);
        d_max = std::max(d_max, d[i]);
    }
    if (!(x_max + slack >= 0 && y_max + slack >= 0 && x_min - slack < width && y_min - slack < height)) return false;
    if (!(x_min > -kFarthestCorner && y_min > -kFarthestCorner && x_max < kFarthestCorner && y_max < kFarthestCorner))
        return false;
    out.x0 = static_cast<int32_t>(std::max(0.0, x_min - slack));  // not negative: truncation is the floor
    out.y0 = static_cast<int32_t>(std::max(0.0, y_min - slack));
    out.x1 = static_cast<int32_t>(std::min(width - 1.0, x_max + slack));
    out.y1 = static_cast<int32_t>(std::min(height - 1.0, y_max + slack));
    SIGHTLINE_DEBUG_ASSERT(0 <= out.x0 && out.x0 <= out.x1 && static_cast<uint32_t>(out.x1) < width);
    SIGHTLINE_DEBUG_ASSERT(0 <= out.y0 && out.y0 <= out.y1 && static_cast<uint32_t>(out.y1) < height);

    const double size = std::max(std::abs(d_min), std::abs(d_max));
    const double corner_error = size * 0x1p-36 + depth_error;
    out.farthest = static_cast<float>(d_min - corner_error - std::abs(d_min) * 0x1p-22);
    out.nearest = static_cast<float>(d_max + corner_error + std::abs(d_max) * 0x1p-22);
    // Inside the polygon a barycentric coordinate is wrong by at most three position errors over a height of the
    // triangle that made the plane, which is kLeastHeight or more: nine such terms, doubled for a quadrangle.
    double depth_error_sum = corner_error + 18.0 / kLeastHeight * position_error * (d_max - d_min);
    out.slack = static_cast<float>(slack);
    // An edge function's coefficients are right to a few steps, and its value is the sum of terms no greater than these.
    const double extent =
        std::max(std::max(std::abs(x_min), std::abs(x_max)), std::max(std::abs(y_min), std::abs(y_max)));
    out.error = position_error + 0x1p-30 + 0x1p-48 * extent;

    out.edges = 0;
    double area2 = 0, best = 0, perimeter = 0;
    int widest = 2;
    for (int i = 2; i < count; ++i) {
        const double part = (x[i - 1] - x[0]) * (y[i] - y[0]) - (x[i] - x[0]) * (y[i - 1] - y[0]);
        area2 += part;
        if (part > best) {
            best = part;
            widest = i;
        }
    }
    for (int i = 0; i < count; ++i) {
        const int j = i + 1 < count ? i + 1 : 0;
        const double length = std::abs(x[j] - x[i]) + std::abs(y[j] - y[i]);
        perimeter += length;
        if (length >= kShortestEdge) out.edge[out.edges++] = makeEdge(x[i], y[i], x[j], y[j], length);
    }
    out.planar = false;
    out.complete = out.edges == count;
    if (area2 <= 4.0 * slack * perimeter) {
        makeBand(x, y, count, std::abs(area2), slack, out);
    } else if (best >= kLeastHeight * perimeter) {
        makePlane(x, y, d, best, widest, out);
        // A quadrangle is flat but for this much, and no farther from the plane anywhere.
        for (int i = 0; i < count; ++i) depth_error_sum += std::abs(out.d0 + out.dx * x[i] + out.dy * y[i] - d[i]);
    }
    SIGHTLINE_DEBUG_ASSERT(out.edges <= 4 && (!out.complete || out.edges == count));
    out.depth_error = static_cast<float>(depth_error_sum * (1.0 + 0x1p-20));
    return true;
}

}  // namespace sightline
