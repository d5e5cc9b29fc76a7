// Draws polygons that share no sides, one by one: each covers the pixels that lie inside all its sides.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_LONE_POLYGON_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_LONE_POLYGON_INL_H
#undef SIGHTLINE_BUFFER_DRAW_LONE_POLYGON_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_LONE_POLYGON_INL_H
#endif

#include "sightline/buffer/draw/convex_cover-inl.h"
#include "sightline/buffer/draw/small_polygons.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kLargeSides = 128.0;  // [pixels]: width and height of a polygon that keeps its seams in any cluster

/// Draws one polygon. Returns whether it left seams.
/// @param turn   which way it winds
/// @param panel  it keeps its seams, however small it is
inline bool drawLone(const ClusterDraw& c, const Corners& k, int turn, bool panel, uint32_t source) {
    DepthTiles& tiles = c.tiles;
    double x0 = k.x[0], x1 = x0, y0 = k.y[0], y1 = y0, d0 = k.d[0], d1 = d0;
    for (int i = 1; i < k.count; ++i) {
        x0 = std::min(x0, k.x[i]);
        x1 = std::max(x1, k.x[i]);
        y0 = std::min(y0, k.y[i]);
        y1 = std::max(y1, k.y[i]);
        d0 = std::min(d0, k.d[i]);
        d1 = std::max(d1, k.d[i]);
    }
    ConvexOutline p;
    if (!p.place(tiles, x0, y0, x1, y1, c.drawn.position_error)) return false;
    ConvexDepth depth;
    const double near = d1 + std::abs(d1) * 0x1p-22 + c.drawn.depth_error;
    depth.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    if (!anyOpen(tiles, p, depth.nearest)) return false;
    const double corner_error = std::max(std::abs(d0), std::abs(d1)) * 0x1p-36 + c.drawn.depth_error;
    depth.floor = static_cast<float>(d0 - corner_error - std::abs(d0) * 0x1p-22);
    const double flat = p.columns <= 2 && p.rows <= 2 ? 0.01 : 0x1p-10;
    if (d1 - d0 > flat * std::abs(d0)) {
        BufferPlane plane;
        if (planeOf(k, c.drawn.depth_error, c.drawn.position_error, plane)) {
            plane.floor = depth.floor;
            depth.add(plane);
        }
    }
    const double left = 8.0 * p.column0, bottom = 8.0 * p.row0;
    for (int i = 0; i < k.count; ++i) {
        const int j = i + 1 < k.count ? i + 1 : 0;
        p.addSide(k.x[i] - left, k.y[i] - bottom, k.x[j] - left, k.y[j] - bottom, turn);
    }
    const bool seams = panel || x1 - x0 + y1 - y0 >= kLargeSides;
    return seams ? coverConvex<true>(tiles, p, depth, source) : coverConvex<false>(tiles, p, depth, source);
}

/// Draws a triangle of some tiles' size from its snapped corners; it leaves no seams.
/// @returns false if it is to be drawn otherwise
inline bool drawMiddle(DepthTiles& tiles, const SmallPolygonsTask& task, const OccluderPolygon& polygon) {
    if (polygon.vertex[3] != OccluderPolygon::kNone) return false;
    const SnappedVertex &a = task.vertices[polygon.vertex[0]], &b = task.vertices[polygon.vertex[1]],
                        &c = task.vertices[polygon.vertex[2]];
    const int32_t x0 = std::min(a.x, std::min(b.x, c.x)), x1 = std::max(a.x, std::max(b.x, c.x));
    const int32_t y0 = std::min(a.y, std::min(b.y, c.y)), y1 = std::max(a.y, std::max(b.y, c.y));
    if (x0 == SnappedVertex::kNone || int64_t{x1} - x0 + y1 - y0 >= static_cast<int64_t>(256 * kLargeSides))
        return false;
    // Twice its area in 1/256 pixel; each coordinate's difference is below 2^15 there.
    const int64_t area = int64_t{b.x - a.x} * (c.y - a.y) - int64_t{c.x - a.x} * (b.y - a.y);
    if (area == 0) return true;
    const int turn = area > 0 ? 1 : -1;
    if (turn != (task.reverse ? -1 : 1) && !polygon.double_sided) return true;
    const int32_t width = static_cast<int32_t>(8 * task.columns), height = static_cast<int32_t>(8 * task.rows);
    if (x1 < 0 || y1 < 0 || x0 >= 256 * width || y0 >= 256 * height) return true;  // no pixel inside it
    ConvexOutline p;
    const double slack = double{task.slack} + 0x1p-9;
    p.reach = slack;
    p.column0 = std::max(x0, 0) >> 11;
    p.row0 = std::max(y0, 0) >> 11;
    p.columns = (std::min(x1 >> 8, width - 1) >> 3) - p.column0 + 1;
    p.rows = (std::min(y1 >> 8, height - 1) >> 3) - p.row0 + 1;
    const double d0 = std::min(a.d, std::min(b.d, c.d)), d1 = std::max(a.d, std::max(b.d, c.d)), range = d1 - d0;
    ConvexDepth depth;
    const double rounding = std::max(std::abs(d0), std::abs(d1)) * 0x1p-22 + task.depth_error;
    depth.nearest = static_cast<float>(d1 + 2.0 * rounding);
    if (!anyOpen(tiles, p, depth.nearest)) return true;
    depth.floor = static_cast<float>(d0 - 2.0 * rounding);
    constexpr int64_t kLeastArea = 1 << 12;  // of twice the area: 1/16 pixel
    if (area * turn >= kLeastArea && range > (p.columns <= 2 && p.rows <= 2 ? 0.01 : 0x1p-10) * std::abs(d0)) {
        const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
        const double ud = double{b.d} - a.d, vd = double{c.d} - a.d, scale = 256.0 / static_cast<double>(area);
        BufferPlane plane;
        plane.dx = (ud * vy - vd * uy) * scale;
        plane.dy = (vd * ux - ud * vx) * scale;
        plane.d0 = a.d - 0x1p-8 * (plane.dx * a.x + plane.dy * a.y);
        plane.floor = depth.floor;
        // A point of the triangle mixes its corners, at each of which the plane is wrong by no more than this.
        const double tilt = std::abs(plane.dx) + std::abs(plane.dy);
        const double error = tilt * slack + rounding + range * 0x1p-30 + std::abs(plane.d0) * 0x1p-46;
        plane.error = static_cast<float>(error * (1.0 + 0x1p-20));
        depth.add(plane);
    }
    const int32_t left = 2048 * p.column0, bottom = 2048 * p.row0;
    p.x_least = 0x1p-8 * (x0 - left);
    p.x_most = 0x1p-8 * (x1 - left);
    p.low = p.inner_low = 0x1p-8 * (y0 - bottom);
    p.high = p.inner_high = 0x1p-8 * (y1 - bottom);
    const SnappedVertex* corner[4] = {&a, &b, &c, &a};
    for (int i = 0; i < 3; ++i) {
        const double dx = corner[i + 1]->x - corner[i]->x, dy = corner[i + 1]->y - corner[i]->y;
        if (dy == 0.0) {  // above or below the others for good: it has the same y at both ends
            const double y = 0x1p-8 * (corner[i]->y - bottom);
            if ((dx > 0.0) == (turn > 0)) p.inner_low = std::max(p.inner_low, y);
            else p.inner_high = std::min(p.inner_high, y);
            continue;
        }
        const double slope = dx / dy, y = 0x1p-8 * (corner[i]->y - bottom);
        const double x = 0x1p-8 * (corner[i]->x - left) + (0.5 - y) * slope;
        // Float adds its own: a few steps of what is computed at any row.
        const double tilt = std::abs(slope), all = std::abs(x) + 8.0 * (p.rows + 1) * tilt;
        const float wide = static_cast<float>(tilt * (0.5 + p.reach) + p.reach + 0x1p-20 * (all + 1.0));
        ((dy < 0.0) == (turn > 0) ? p.left : p.right).add(x, slope, wide);
    }
    coverConvex<false>(tiles, p, depth, 0);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
