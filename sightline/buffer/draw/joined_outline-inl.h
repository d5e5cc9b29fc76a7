// Polygons of a joined cluster whose open edges run around something convex: drawn by their outline.
// SPDX-License-Identifier: MIT
//
// The front faces of a convex body are such polygons. What follows is sound for any: the outline's argument asks only for
// closed chains of sides, the depth's for the planes of all polygons. That they bound something convex makes it tight.
#if defined(SIGHTLINE_BUFFER_DRAW_JOINED_OUTLINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_JOINED_OUTLINE_INL_H
#undef SIGHTLINE_BUFFER_DRAW_JOINED_OUTLINE_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_JOINED_OUTLINE_INL_H
#endif

#include "sightline/buffer/draw/convex_cover-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Open edges as sides of what lies on their left.
struct JoinedOutline {
    double ax[HandSides::kMost], ay[HandSides::kMost], bx[HandSides::kMost], by[HandSides::kMost];
    int count = 0;
    double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;  ///< [pixels]

    inline bool gather(const OpenEdges& open);
};

/// @returns false if they are too many, or do not run around something convex
inline bool JoinedOutline::gather(const OpenEdges& open) {
    constexpr double kBent = 0x1p-6;  // [pixels] that a corner may lie outside a side; its pixels are lost, no more
    if (open.count < 3 || open.count > HandSides::kMost) return false;
    count = open.count;
    for (int i = 0; i < count; ++i) {
        const bool on_left = open.change[i] > 0;
        ax[i] = on_left ? open.ax[i] : open.bx[i];
        ay[i] = on_left ? open.ay[i] : open.by[i];
        bx[i] = on_left ? open.bx[i] : open.ax[i];
        by[i] = on_left ? open.by[i] : open.ay[i];
        x0 = std::min(x0, ax[i]);
        x1 = std::max(x1, ax[i]);
        y0 = std::min(y0, ay[i]);
        y1 = std::max(y1, ay[i]);
    }
    for (int i = 0; i < count; ++i) {
        const double ux = bx[i] - ax[i], uy = by[i] - ay[i], least = -kBent * (std::abs(ux) + std::abs(uy));
        for (int k = 0; k < count; ++k)
            if (!(ux * (ay[k] - ay[i]) - uy * (ax[k] - ax[i]) >= least)) return false;
    }
    return true;
}

/// Gathers the planes of polygons that together look like the front of something convex; each outlives a call.
class FrontPlanes {
public:
    /// @returns false if it is one too many, or has no plane to rely on
    bool add(const ClusterDraw& c, const Corners& corners) {
        if (depth_.count == ConvexDepth::kMost) return false;
        double d0 = corners.d[0], d1 = d0;
        for (int i = 1; i < corners.count; ++i) {
            d0 = std::min(d0, corners.d[i]);
            d1 = std::max(d1, corners.d[i]);
        }
        BufferPlane plane;
        if (!planeOf(corners, c.drawn.depth_error, c.drawn.position_error, plane)) return false;
        const double error = std::max(std::abs(d0), std::abs(d1)) * 0x1p-36 + c.drawn.depth_error;
        plane.floor = static_cast<float>(d0 - error - std::abs(d0) * 0x1p-22);
        corners_[depth_.count] = corners;
        depth_.add(plane);
        farthest_ = std::min(farthest_, d0);
        nearest_ = std::max(nearest_, d1);
        return true;
    }

    /// @returns false if some corner lies in front of another polygon's plane
    bool finish(double depth_error, ConvexDepth& out) {
        const double bent = (nearest_ - farthest_) * 0x1p-10;
        for (int k = 0; k < depth_.count; ++k)
            for (int j = 0; j < depth_.count; ++j) {
                if (j == k) continue;
                const BufferPlane& plane = depth_.plane[k];
                const Corners& corners = corners_[j];
                for (int i = 0; i < corners.count; ++i)
                    if (corners.d[i] >
                        plane.d0 + plane.dx * corners.x[i] + plane.dy * corners.y[i] + plane.error + bent)
                        return false;
            }
        const double near = nearest_ + std::abs(nearest_) * 0x1p-22 + depth_error;
        depth_.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
        depth_.floor = depth_.count == 0 ? 0.0f : depth_.plane[0].floor;
        for (int k = 1; k < depth_.count; ++k) depth_.floor = std::min(depth_.floor, depth_.plane[k].floor);
        out = depth_;
        return depth_.count > 0;
    }

private:
    ConvexDepth depth_;
    Corners corners_[ConvexDepth::kMost];
    double nearest_ = -1e300, farthest_ = 1e300;
};

/// @returns whether seams are left
inline bool drawOutline(const ClusterDraw& c, const JoinedOutline& o, ConvexDepth& depth, uint32_t source) {
    DepthTiles& tiles = c.tiles;
    ConvexOutline p;
    if (!p.place(tiles, o.x0, o.y0, o.x1, o.y1, c.drawn.position_error) || !anyOpen(tiles, p, depth.nearest))
        return false;
    const double left = 8.0 * p.column0, bottom = 8.0 * p.row0;
    for (int i = 0; i < o.count; ++i) p.addSide(o.ax[i] - left, o.ay[i] - bottom, o.bx[i] - left, o.by[i] - bottom, 1);
    return coverConvex<true>(tiles, p, depth, source);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
