// Convex polygons of the image: cutting, hulls.
// SPDX-License-Identifier: MIT
#include "sightline/cells/window_polygon.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

double crossOf(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double heightOf(const WindowLine& line, const glm::dvec2& point) {
    return line.x * point.x + line.y * point.y + line.z;
}

}  // namespace

void WindowPolygon::findBounds() {
    bounds = WindowBounds::nothing();
    for (uint32_t i = 0; i < count; ++i) bounds.grow(points[i].x, points[i].y);
}

double WindowPolygon::area() const {
    double twice = 0;
    for (uint32_t i = 1; i + 1 < count; ++i) twice += crossOf(points[i] - points[0], points[i + 1] - points[0]);
    return 0.5 * twice;
}

bool WindowPolygon::isWithin(const WindowPolygon& other, double slack) const {
    SIGHTLINE_DEBUG_ASSERT(count <= kMost && other.count <= kMost);
    for (int i = 0; i < 8; ++i)
        if (bounds.most[i] > other.bounds.most[i] + slack) return false;
    for (uint32_t i = 0; i < other.count; ++i) {
        const glm::dvec2 from = other.points[i], edge = other.points[i + 1 == other.count ? 0 : i + 1] - from;
        const double least = -slack * std::sqrt(edge.x * edge.x + edge.y * edge.y);
        for (uint32_t k = 0; k < count; ++k)
            if (!(crossOf(edge, points[k] - from) >= least)) return false;
    }
    return true;
}

void cutPolygon(WindowPolygon& polygon, const WindowLine& line) {
    SIGHTLINE_DEBUG_ASSERT(polygon.count <= WindowPolygon::kMost);
    double heights[WindowPolygon::kMost];
    bool all = true, none = true;
    for (uint32_t i = 0; i < polygon.count; ++i) {
        heights[i] = heightOf(line, polygon.points[i]);
        all &= heights[i] >= 0;
        none &= heights[i] < 0;
    }
    if (all) return;
    if (none) {
        polygon.count = 0;
        return;
    }
    glm::dvec2 left[2 * WindowPolygon::kMost];
    uint32_t count = 0;
    for (uint32_t i = 0; i < polygon.count; ++i) {
        const uint32_t next = i + 1 == polygon.count ? 0 : i + 1;
        const glm::dvec2 &a = polygon.points[i], &b = polygon.points[next];
        if (heights[i] >= 0) left[count++] = a;
        if ((heights[i] >= 0) == (heights[next] >= 0)) continue;
        left[count++] = a + heights[i] / (heights[i] - heights[next]) * (b - a);
    }
    if (count > WindowPolygon::kMost) return;
    std::copy(left, left + count, polygon.points);
    polygon.count = count;
}

bool shareEdge(const WindowPolygon& a, const WindowPolygon& b, double slack) {
    const auto same = [&](const glm::dvec2& p, const glm::dvec2& q) {
        return std::abs(p.x - q.x) <= slack && std::abs(p.y - q.y) <= slack;
    };
    for (uint32_t i = 0; i < a.count; ++i)
        for (uint32_t k = 0; k < b.count; ++k)
            if (same(a.points[i], b.points[k]) &&
                same(a.points[i + 1 == a.count ? 0 : i + 1], b.points[k == 0 ? b.count - 1 : k - 1]))
                return true;
    return false;
}

WindowPolygon polygonOf(const WindowBounds& bounds) {
    const double* most = bounds.most;
    WindowPolygon polygon;
    polygon.points[0] = {-most[1], -most[3]};
    polygon.points[1] = {most[0], -most[3]};
    polygon.points[2] = {most[0], most[2]};
    polygon.points[3] = {-most[1], most[2]};
    polygon.count = 4;
    cutPolygon(polygon, {-1, -1, most[4]});
    cutPolygon(polygon, {1, 1, most[5]});
    cutPolygon(polygon, {-1, 1, most[6]});
    cutPolygon(polygon, {1, -1, most[7]});
    polygon.findBounds();
    return polygon;
}

WindowPolygon hullOf(const WindowPolygon& a, const WindowPolygon& b) {
    SIGHTLINE_DEBUG_ASSERT(a.count > 0 && a.count <= WindowPolygon::kMost && b.count > 0 &&
                           b.count <= WindowPolygon::kMost);
    glm::dvec2 points[2 * WindowPolygon::kMost], hull[4 * WindowPolygon::kMost + 1];
    std::copy(a.points, a.points + a.count, points);
    std::copy(b.points, b.points + b.count, points + a.count);
    const uint32_t count = a.count + b.count;
    std::sort(points, points + count,
              [](const glm::dvec2& p, const glm::dvec2& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
    uint32_t size = 0;
    const auto add = [&](const glm::dvec2& point, uint32_t base) {
        while (size >= base + 2 && !(crossOf(hull[size - 1] - hull[size - 2], point - hull[size - 1]) > 0)) --size;
        hull[size++] = point;
    };
    for (uint32_t i = 0; i < count; ++i) add(points[i], 0);
    const uint32_t upper = size - 1;
    for (uint32_t i = count - 1; i-- > 0;) add(points[i], upper);
    --size;  // the first point once more
    WindowPolygon joined;
    if (size < 3 || size > WindowPolygon::kMost) {
        WindowBounds bounds = a.bounds;
        bounds.grow(b.bounds);
        return polygonOf(bounds);
    }
    std::copy(hull, hull + size, joined.points);
    joined.count = size;
    joined.findBounds();
    return joined;
}

}  // namespace sightline
