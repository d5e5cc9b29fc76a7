// Draws occluder clusters into the depth tiles: projection, which polygons are drawn, patches of them.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/buffer/tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/ablate.h"
#include "sightline/buffer/draw/loose.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/draw/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/dense-inl.h"
#include "sightline/buffer/draw/joined_outline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Per polygon of a cluster which way it winds on the screen, 0 if it is not drawn; and how many are drawn each way.
struct Windings {
    int8_t turn[kMaxAtOnce];
    Place place[kMaxAtOnce];
    int count = 0;
    int forward = 0, backward = 0;  ///< that are drawn: counter-clockwise, clockwise
};

/// Slivers wind as their rounding says. Where they are more than a few, those are left out, so that the winding number of
/// a pixel, which counts in a byte, stays above -128 for sure.
constexpr int kMaxSlivers = 64;
constexpr double kSliver = 0x1p-20;  // [pixels^2]: above the rounding of twice an area between pixels that are drawn

void windPolygons(const ClusterDraw& c, bool regular, Windings& out) {
    out.count = static_cast<int>(c.cluster.polygon_count + c.cluster.ring_count);
    int slivers = 0;
    for (int p = 0; p < out.count; ++p) {
        const OccluderPolygon& polygon = c.polygons[p];
        out.turn[p] = 0;
        out.place[p] = regular ? Place::kRegular : placeOf(c, polygon);
        if (out.place[p] == Place::kUndrawn) continue;
        const double area = out.place[p] == Place::kRegular ? areaOf(c, polygon) : windingOf(c, polygon);
        if (std::abs(area) < kSliver && ++slivers > kMaxSlivers) continue;
        const int8_t turn = area > 0.0 ? 1 : area < 0.0 ? -1 : c.front;
        if (turn != c.front && !polygon.double_sided) continue;
        out.turn[p] = turn;
        ++(turn > 0 ? out.forward : out.backward);
    }
}

/// Where an edge that crosses the near plane meets it, the same for both directions.
struct Cut {
    double x, y;
};

/// The open edges of the polygons that wind one way, in a cluster that the near plane cuts: each side up to the plane,
/// and along the plane from where a polygon's boundary leaves to where it comes back.
class CutEdges {
public:
    CutEdges(const ClusterDraw& c, Windings& windings) : c_(c), windings_(windings) {
        for (int p = 0; p < windings.count; ++p) leaves_[p] = returns_[p] = kNoneYet;
        const OccluderEdge* edges = c.drawn.occluder->edges.data() + c.cluster.first_edge;
        for (uint32_t i = 0; i < c.cluster.edge_count; ++i) {
            const bool from = !std::isnan(c.x[edges[i].from]), to = !std::isnan(c.x[edges[i].to]);
            if (from == to) continue;
            const bool good = i < kMaxEdges && cut(i, edges[i], from);
            note(edges[i].left, from, good ? static_cast<int>(i) : kUnusable);
            note(edges[i].right, to, good ? static_cast<int>(i) : kUnusable);
        }
        for (int p = 0; p < windings.count; ++p)
            if (!isWhole(p)) windings.turn[p] = 0;
    }

    /// @returns false if it has no part before the near plane, else its ends
    bool clip(uint32_t edge, const OccluderEdge& e, double (&ends)[4]) const {
        const bool from = !std::isnan(c_.x[e.from]), to = !std::isnan(c_.x[e.to]);
        if (!from && !to) return false;
        ends[0] = from ? c_.x[e.from] : cut_[edge].x;
        ends[1] = from ? c_.y[e.from] : cut_[edge].y;
        ends[2] = to ? c_.x[e.to] : cut_[edge].x;
        ends[3] = to ? c_.y[e.to] : cut_[edge].y;
        return true;
    }

    /// Adds the sides along the near plane.
    void addPlaneSides(OpenEdges& open, int8_t turn) const {
        for (int p = 0; p < windings_.count; ++p) {
            if (windings_.turn[p] != turn || windings_.place[p] != Place::kCut) continue;
            const Cut &a = cut_[leaves_[p]], &b = cut_[returns_[p]];
            open.add(a.x, a.y, b.x, b.y, turn);
        }
    }

private:
    static constexpr uint32_t kMaxEdges = 1024;
    static constexpr int kNoneYet = -1, kUnusable = -2;

    bool cut(uint32_t i, const OccluderEdge& edge, bool from) {
        Cut& at = cut_[i];
        return cutAtNear(c_.object, *c_.drawn.occluder, c_.cluster, from ? edge.from : edge.to,
                         from ? edge.to : edge.from, at.x, at.y) &&
               std::abs(at.x) < kFarthestCorner && std::abs(at.y) < kFarthestCorner;
    }

    /// @param out  the polygon's boundary, in the order of its corners, leaves the drawn part here; else it returns
    void note(uint8_t polygon, bool out, int edge) {
        if (polygon == OccluderEdge::kNone) return;
        int& place = out ? leaves_[polygon] : returns_[polygon];
        place = place == kNoneYet ? edge : kUnusable;
    }

    /// A polygon is drawn if its boundary leaves the drawn part once and comes back once, or never does.
    bool isWhole(int p) const {
        if (windings_.place[p] != Place::kCut) return leaves_[p] == kNoneYet && returns_[p] == kNoneYet;
        return leaves_[p] >= 0 && returns_[p] >= 0 && cutCorners(c_, c_.polygons[p]).count >= 3;
    }

    const ClusterDraw& c_;
    Windings& windings_;
    Cut cut_[kMaxEdges];                            ///< per edge
    int leaves_[kMaxAtOnce], returns_[kMaxAtOnce];  ///< per polygon: on which edge
};

/// The corners of a polygon, as far as they lie before the near plane.
Corners cornersBefore(const ClusterDraw& c, const Windings& windings, int p) {
    return windings.place[p] == Place::kCut ? cutCorners(c, c.polygons[p]) : cornersOf(c, c.polygons[p]);
}

/// Draws the polygons that wind one way by their outline, if they look like the front of something convex.
/// @param seams  whether some are left
/// @returns false if they do not
bool drawAsOutline(const ClusterDraw& c, const Windings& windings, const OpenEdges& open, int8_t turn, uint32_t source,
                   bool& seams) {
    if (detail::kAblate.outlines) return false;
    JoinedOutline outline;
    if ((turn > 0 ? windings.forward : windings.backward) > ConvexDepth::kMost || !outline.gather(open)) return false;
    FrontPlanes planes;
    for (int p = 0; p < windings.count; ++p) {
        if (windings.turn[p] != turn) continue;
        const Corners corners = cornersBefore(c, windings, p);
        if (corners.count >= 3 && !planes.add(c, corners)) return false;
    }
    ConvexDepth depth;
    if (!planes.finish(c.drawn.depth_error, depth)) return false;
    seams = drawOutline(c, outline, depth, source);
    return true;
}

/// Draws the polygons of a joined cluster that wind one way.
/// @returns whether seams are left
bool drawJoined(const ClusterDraw& c, const Projected& projected, const Windings& windings, const CutEdges* cuts,
                int8_t turn, uint32_t source) {
    source |= SeamEntry::kAllPolygons;
    OpenEdges open;
    const OccluderEdge* edges = c.drawn.occluder->edges.data() + c.cluster.first_edge;
    for (uint32_t i = 0; i < c.cluster.edge_count; ++i) {
        const OccluderEdge& e = edges[i];
        const int change = (e.left != OccluderEdge::kNone && windings.turn[e.left] == turn ? turn : 0) -
                           (e.right != OccluderEdge::kNone && windings.turn[e.right] == turn ? turn : 0);
        if (change == 0) continue;
        double ends[4] = {c.x[e.from], c.y[e.from], c.x[e.to], c.y[e.to]};
        if (cuts && !cuts->clip(i, e, ends)) continue;
        open.add(ends[0], ends[1], ends[2], ends[3], change);
    }
    if (cuts) cuts->addPlaneSides(open, turn);
    if (bool seams = false; drawAsOutline(c, windings, open, turn, source, seams)) return seams;
    Patch patch = makePatch(c);
    Extent extent = projected.extent;
    if (cuts)
        for (int p = 0; p < windings.count; ++p) {
            if (windings.turn[p] != turn || windings.place[p] != Place::kCut) continue;
            const Corners corners = cutCorners(c, c.polygons[p]);
            for (int i = 0; i < corners.count; ++i) extent.grow(corners.x[i], corners.y[i], corners.d[i]);
        }
    if (!beginPatch(patch, extent)) return false;
    for (int p = 0; p < windings.count; ++p) {
        if (windings.turn[p] != turn) continue;
        const Corners corners = cornersBefore(c, windings, p);
        if (corners.count >= 3) addDepth(patch, corners, turn);
    }
    addOpenEdges(patch, open);
    return coverPatch(patch, source);
}

/// @returns false, with nothing drawn, if it is a loose one
bool drawJoinedKernel(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    SIGHTLINE_DEBUG_ASSERT(source.vertex_count <= OccluderCluster::kMaxVertices && source.first_vertex % 8 == 0);
    SIGHTLINE_DEBUG_ASSERT(source.polygon_count <= OccluderCluster::kMaxOwn);
    SIGHTLINE_DEBUG_ASSERT(source.polygon_count + source.ring_count <= OccluderCluster::kMaxPolygons);
    if (source.edge_count == 0 || source.edge_count + kMaxAtOnce > OpenEdges::kMost) return false;
    const size_t first = roomForVertices(tiles, source);
    const Projected projected = projectVertices(object, *cluster.occluder, source, tiles.px.data() + first,
                                                tiles.py.data() + first, tiles.pd.data() + first);
    const ClusterDraw c{tiles,
                        object,
                        cluster,
                        source,
                        cluster.occluder->polygons.data() + source.first_polygon,
                        tiles.px.data() + first,
                        tiles.py.data() + first,
                        tiles.pd.data() + first,
                        static_cast<int8_t>(flips != object.mirrored ? -1 : 1)};
    // Draws those of one winding.
    const auto drawTurn = [&](int8_t turn, auto draw) {
        if (!draw(turn, static_cast<uint32_t>(tiles.drawn.size()) << 8)) return;
        keepDrawn(c, turn, first, projected.regular);
    };
    const int8_t back = static_cast<int8_t>(-c.front);
    if (!detail::kAblate.dense && projected.regular && isDense(c, projected.extent)) {
        DenseDraw dense(c, projected);
        if (dense.begin()) {
            drawTurn(c.front, [&](int8_t turn, uint32_t name) { return dense.draw(turn, name, false); });
            drawTurn(back, [&](int8_t turn, uint32_t name) { return dense.draw(turn, name, true); });
        }
    } else {
        Windings windings;
        windPolygons(c, projected.regular, windings);
        const auto drawBoth = [&](const CutEdges* cuts) {
            const auto draw = [&](int8_t turn, uint32_t name) {
                if ((turn > 0 ? windings.forward : windings.backward) == 0) return false;
                return drawJoined(c, projected, windings, cuts, turn, name);
            };
            drawTurn(c.front, draw);
            drawTurn(back, draw);
        };
        if (projected.regular) {
            drawBoth(nullptr);
        } else if (windings.forward + windings.backward > 0) {
            const CutEdges cuts(c, windings);
            drawBoth(&cuts);
        }
    }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawJoinedKernel);

void drawCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    SIGHTLINE_DEBUG_ASSERT(cluster.occluder != nullptr && cluster.transform != nullptr);
    SIGHTLINE_DEBUG_ASSERT(cluster.cluster < cluster.occluder->clusters.size());
    SIGHTLINE_DEBUG_ASSERT(cluster.position_error >= 0 && cluster.depth_error >= 0);
    SIGHTLINE_DEBUG_ASSERT(tiles.width > 0 && tiles.height > 0);
    if (!HWY_DYNAMIC_DISPATCH(drawJoinedKernel)(tiles, cluster, object, flips))
        drawLooseCluster(tiles, cluster, object, flips);
}

}  // namespace sightline
#endif  // HWY_ONCE
