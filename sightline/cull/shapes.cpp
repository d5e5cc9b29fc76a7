// Shapes asked of the depth tiles: rectangles, boxes by their faces, spheres, convex hulls.
// SPDX-License-Identifier: MIT
#include "sightline/cull/shapes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kShapeRounding = 0x1p-46;  // of sums of a few products of doubles, with room to spare
constexpr double kWorstPosition = 0.125;    // [pixels]: known less exactly, it is visible
constexpr double kSlack = 0x1p-20;          // [pixels]: what rounding moves a place inside the buffer by, with room

/// The whole pixels that bounds meet. The nearness is the caller's.
Sight toPixels(const Screen& screen, double x0, double y0, double x1, double y1, PixelRect& rect) {
    if (!(x0 <= x1 && y0 <= y1)) return Sight::kVisible;
    if (x1 < 0 || y1 < 0 || x0 > screen.width || y0 > screen.height) return Sight::kOutside;
    rect.x0 = static_cast<int32_t>(std::clamp(x0, 0.0, screen.width - 1.0));
    rect.y0 = static_cast<int32_t>(std::clamp(y0, 0.0, screen.height - 1.0));
    rect.x1 = static_cast<int32_t>(std::clamp(x1, 0.0, screen.width - 1.0));
    rect.y1 = static_cast<int32_t>(std::clamp(y1, 0.0, screen.height - 1.0));
    SIGHTLINE_DEBUG_ASSERT(rect.x0 <= rect.x1 && rect.y0 <= rect.y1);
    return Sight::kOccluded;
}

float nearer(double nearness) { return static_cast<float>(nearness + std::abs(nearness) * 0x1p-22); }

/// Points of the buffer with the room that their rounding needs.
struct Images {
    double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
    double w_least = x0, d_most = -x0;
    double position_error = 0, depth_error = 0;
    bool sure = true;

    void add(const OccludeePlace& place, const glm::dvec3& p, double& px, double& py, double& pd) {
        const glm::dvec4 h(p, 1.0);
        const Screen& screen = place.screen;
        const double w = glm::dot(screen.w, h), near = glm::dot(screen.near, h);
        const double size = glm::dot(glm::abs(screen.near), glm::abs(h));
        sure = sure && near > kShapeRounding * size && w > kShapeRounding * glm::dot(glm::abs(screen.w), glm::abs(h));
        px = glm::dot(screen.x, h) / w;
        py = glm::dot(screen.y, h) / w;
        pd = glm::dot(screen.d, h) / w;
        w_least = std::min(w_least, w);
        d_most = std::max(d_most, pd);
        x0 = std::min(x0, px);
        x1 = std::max(x1, px);
        y0 = std::min(y0, py);
        y1 = std::max(y1, py);
    }

    /// Once all are in.
    Sight finish(const OccludeePlace& place, PixelRect& rect) {
        if (!sure || !place.clips) return Sight::kVisible;
        position_error = place.positionError(w_least) + kSlack;
        depth_error = place.depthError(w_least);
        if (!(position_error < kWorstPosition)) return Sight::kVisible;
        const Sight sight = toPixels(place.screen, x0 - position_error, y0 - position_error, x1 + position_error,
                                     y1 + position_error, rect);
        rect.nearness = nearer(d_most + depth_error + std::abs(d_most) * 0x1p-36);
        return std::isfinite(rect.nearness) ? sight : Sight::kVisible;
    }
};

Sight asked(bool hidden) { return hidden ? Sight::kOccluded : Sight::kVisible; }

/// The bounds of a sphere's image along one row of the map: s such that the plane of all points with row.h = s w.h
/// touches the sphere. False if the eye's plane does not leave it whole on one side.
bool sphereBounds(const glm::dvec4& row, const glm::dvec4& w, const glm::dvec3& center, double radius, double& low,
                  double& high) {
    SIGHTLINE_DEBUG_ASSERT(radius >= 0);
    // |(row - s w).(c, 1)| = r |row - s w|, squared: a s^2 - 2 b s + c = 0.
    const glm::dvec4 h(center, 1.0);
    const glm::dvec3 n(row), m(w);
    const double x = glm::dot(row, h), y = glm::dot(w, h), r2 = radius * radius;
    const double a = y * y - r2 * glm::dot(m, m), b = x * y - r2 * glm::dot(n, m), c = x * x - r2 * glm::dot(n, n);
    if (!(a > 0x1p-40 * y * y)) return false;
    const double size = std::abs(x * y) + r2 * glm::length(n) * glm::length(m);
    const double root = std::sqrt(std::max(0.0, b * b - a * c) + 0x1p-44 * (size * size + std::abs(a * c)));
    low = (b - root) / a;
    high = (b + root) / a;
    const double slack = kSlack + 0x1p-36 * (size / a + std::abs(low) + std::abs(high));
    low -= slack;
    high += slack;
    return std::isfinite(low) && std::isfinite(high);
}

/// The hull of points of the plane, counter-clockwise, in place; returns how many are left.
/// A. M. Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. 1979.
size_t hullOf(Array<glm::dvec2>& points, Array<glm::dvec2>& hull) {
    SIGHTLINE_DEBUG_ASSERT(!points.empty());
    std::sort(points.begin(), points.end(),
              [](const glm::dvec2& p, const glm::dvec2& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
    hull.resize(2 * points.size() + 1);
    const auto turns = [](const glm::dvec2& o, const glm::dvec2& p, const glm::dvec2& q) {
        return (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x) > 0;
    };
    size_t count = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        while (count >= 2 && !turns(hull[count - 2], hull[count - 1], points[i])) --count;
        hull[count++] = points[i];
    }
    for (size_t i = points.size() - 1, lower = count + 1; i-- > 0;) {
        while (count >= lower && !turns(hull[count - 2], hull[count - 1], points[i])) --count;
        hull[count++] = points[i];
    }
    return count - 1;
}

}  // namespace

Sight askRect(DepthTiles& tiles, const Screen& screen, const View& view, const ViewportRect& rect) {
    const double sx = screen.width / (view.width + 2.0 * view.jitter);
    const double sy = screen.height / (view.height + 2.0 * view.jitter);
    const double x0 = (rect.left + view.jitter) * sx, x1 = (rect.right + view.jitter) * sx;
    const double y0 = (view.height + view.jitter - rect.bottom) * sy, y1 = (view.height + view.jitter - rect.top) * sy;
    const double extent = std::abs(x0) + std::abs(x1) + std::abs(y0) + std::abs(y1);
    const double slack = kSlack + 0x1p-48 * extent;
    PixelRect pixels;
    const Sight sight = toPixels(screen, x0 - slack, y0 - slack, x1 + slack, y1 + slack, pixels);
    if (sight != Sight::kOccluded) return sight;
    if (!std::isfinite(rect.depth) || (screen.perspective && !(rect.depth > 0.0))) return Sight::kVisible;
    // w is the depth, up to the projection's scale of it.
    const double scale = screen.perspective ? glm::length(glm::dvec3(screen.w)) : 1.0;
    pixels.nearness = nearer(screen.perspective ? 1.0 / (rect.depth * scale) : -rect.depth);
    return asked(isHidden(tiles, pixels));
}

Sight makeBoxFaces(const OccludeePlace& place, const Box3d& box, BoxFaces& out) {
    // Counter-clockwise from outside; bit k of a corner's number is the bound on axis k.
    static constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    out.count = 0;
    double x[8], y[8], d[8];
    Images images;
    for (int i = 0; i < 8; ++i)
        images.add(place, {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z},
                   x[i], y[i], d[i]);
    const Sight sight = images.finish(place, out.rect);
    if (sight != Sight::kOccluded) return sight;
    for (const auto& face : kFaces) {
        double fx[4], fy[4], fd[4], perimeter = 0;
        for (int k = 0; k < 4; ++k) fx[k] = x[face[k]], fy[k] = y[face[k]], fd[k] = d[face[k]];
        for (int k = 0; k < 4; ++k) perimeter += std::abs(fx[(k + 1) & 3] - fx[k]) + std::abs(fy[(k + 1) & 3] - fy[k]);
        const double area2 = (fx[2] - fx[0]) * (fy[3] - fy[1]) - (fx[3] - fx[1]) * (fy[2] - fy[0]);
        if ((place.reverse ? -area2 : area2) < -4.0 * (images.position_error + 0x1p-16) * perimeter) continue;
        const Sight made = makeOccludeePolygon(fx, fy, fd, 4, images.position_error, images.depth_error,
                                               place.screen.width, place.screen.height, out.faces[out.count]);
        if (made == Sight::kVisible) return made;
        out.count += made == Sight::kOccluded;
        SIGHTLINE_DEBUG_ASSERT(out.count <= 6);
    }
    return out.count > 0 ? sight : Sight::kOutside;
}

Sight askBox(DepthTiles& tiles, const OccludeePlace& place, const Box3d& box) {
    BoxFaces faces;
    const Sight sight = makeBoxFaces(place, box, faces);
    const OccludeeBox whole = boxAt(place, box);
    if (sight != Sight::kOccluded || !tiles.clip(faces.rect) || isHidden(tiles, faces.rect, Seams::kLeave, &whole))
        return sight;
    uint32_t undecided = 0;
    bool in_view = false;
    for (int i = 0; i < faces.count; ++i) {
        if (!tiles.clip(faces.faces[i].rect)) {
            in_view = true;
            continue;
        }
        const Cover cover = lookAt(tiles, faces.faces[i], &whole);
        if (cover == Cover::kOpen) return Sight::kVisible;
        if (cover == Cover::kUndecided) undecided |= 1u << i;
        in_view |= cover != Cover::kOutside;
    }
    for (; undecided; undecided &= undecided - 1)
        if (!resolveHidden(tiles, faces.faces[std::countr_zero(undecided)], &whole)) return Sight::kVisible;
    return in_view ? Sight::kOccluded : Sight::kOutside;
}

Sight askSphere(DepthTiles& tiles, const Screen& screen, const glm::dvec3& center, double radius) {
    const glm::dvec3 c = center - screen.eye;
    const glm::dvec4 h(c, 1.0);
    const auto least = [&](const glm::dvec4& row) {
        const double size = glm::dot(glm::abs(row), glm::abs(h)) + radius * glm::length(glm::dvec3(row));
        return glm::dot(row, h) - radius * glm::length(glm::dvec3(row)) - kShapeRounding * size;
    };
    if (!(radius >= 0.0 && least(screen.near) > 0.0 && least(screen.w) > 0.0)) return Sight::kVisible;
    // Across, up, and along both diagonals.
    const glm::dvec4 rows[4] = {screen.x, screen.y, 0.5 * (screen.x + screen.y), 0.5 * (screen.x - screen.y)};
    double low[4], high[4];
    for (int i = 0; i < 4; ++i)
        if (!sphereBounds(rows[i], screen.w, c, radius, low[i], high[i])) return Sight::kVisible;
    OccludeePolygon polygon;
    const Sight sight = toPixels(screen, low[0], low[1], high[0], high[1], polygon.rect);
    if (sight != Sight::kOccluded) return sight;
    const double nearness = screen.perspective ? 1.0 / least(screen.w) : -least(-screen.d);
    polygon.rect.nearness = nearer(nearness);
    if (!std::isfinite(polygon.rect.nearness)) return Sight::kVisible;
    if (isHidden(tiles, polygon.rect, Seams::kLeave)) return Sight::kOccluded;
    polygon.d0 = polygon.rect.nearness;
    polygon.slack = 0x1p-14f;
    polygon.edges = 4;
    for (int i = 0; i < 4; ++i) {
        const double sign = i & 1 ? -1.0 : 1.0, across = i < 2 ? 0.5 : -0.5;
        polygon.a[i] = sign * 0.5;
        polygon.b[i] = sign * across;
        polygon.c[i] = i & 1 ? high[2 + i / 2] : -low[2 + i / 2];
    }
    return asked(isPolygonHidden(tiles, polygon));
}

Sight askPoints(DepthTiles& tiles, const OccludeePlace& place, std::span<const glm::vec3> points) {
    if (points.empty()) return Sight::kVisible;
    Memory* memory = tiles.memory;
    Array<glm::dvec2> images(memory), hull(memory);
    images.resize(points.size());
    Images bounds;
    double depth;
    for (size_t i = 0; i < points.size(); ++i) bounds.add(place, points[i], images[i].x, images[i].y, depth);
    PixelRect rect;
    const Sight sight = bounds.finish(place, rect);
    if (sight != Sight::kOccluded || isHidden(tiles, rect, Seams::kLeave)) return sight;
    const size_t count = hullOf(images, hull);
    if (count < 3) return asked(isHidden(tiles, rect));
    // A fan of quadrangles, each with the nearest depth of all: what lies between the points may be nearer than they.
    for (size_t i = 1; i + 1 < count; i += 2) {
        const size_t corner[4] = {0, i, i + 1, std::min(i + 2, count - 1)};
        double x[4], y[4], d[4];
        for (int k = 0; k < 4; ++k) x[k] = hull[corner[k]].x, y[k] = hull[corner[k]].y, d[k] = bounds.d_most;
        OccludeePolygon polygon;
        const Sight made = makeOccludeePolygon(x, y, d, 4, bounds.position_error, bounds.depth_error,
                                               place.screen.width, place.screen.height, polygon);
        if (made == Sight::kVisible || (made == Sight::kOccluded && !isPolygonHidden(tiles, polygon)))
            return Sight::kVisible;
    }
    return Sight::kOccluded;
}

Sight askHull(DepthTiles& tiles, const OccludeePlace& place, const HullView& hull) {
    Images bounds;
    double x[OccludeePolygon::kMaxCorners], y[OccludeePolygon::kMaxCorners], d[OccludeePolygon::kMaxCorners];
    for (const glm::vec3& p : hull.points) bounds.add(place, p, x[0], y[0], d[0]);
    PixelRect rect;
    const Sight sight = bounds.finish(place, rect);
    if (sight != Sight::kOccluded || isHidden(tiles, rect, Seams::kLeave)) return sight;
    size_t first = 0;
    for (const uint32_t size : hull.face_sizes) {
        if (size < 3 || size > OccludeePolygon::kMaxCorners || first + size > hull.corners.size())
            return asked(isHidden(tiles, rect));
        double area2 = 0, perimeter = 0;
        Images unused;
        for (uint32_t k = 0; k < size; ++k) unused.add(place, hull.points[hull.corners[first + k]], x[k], y[k], d[k]);
        first += size;
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t next = k + 1 < size ? k + 1 : 0;
            perimeter += std::abs(x[next] - x[k]) + std::abs(y[next] - y[k]);
            area2 += (x[k] - x[0]) * (y[next] - y[0]) - (x[next] - x[0]) * (y[k] - y[0]);
        }
        if ((place.reverse ? -area2 : area2) < -4.0 * (bounds.position_error + 0x1p-16) * perimeter) continue;
        OccludeePolygon polygon;
        const Sight made = makeOccludeePolygon(x, y, d, static_cast<int>(size), bounds.position_error,
                                               bounds.depth_error, place.screen.width, place.screen.height, polygon);
        if (made == Sight::kVisible || (made == Sight::kOccluded && !isPolygonHidden(tiles, polygon)))
            return Sight::kVisible;
    }
    return Sight::kOccluded;
}

}  // namespace sightline
