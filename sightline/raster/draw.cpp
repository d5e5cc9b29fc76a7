// Draws occluder clusters into the depth tiles: projection, which polygons are drawn, patches of them.
// SPDX-License-Identifier: MIT
#include "sightline/raster/tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/raster/near_clip.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/raster/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/raster/patch_cover-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kFarthestCorner = 0x1p24;  // [pixels]: polygons with a corner farther away are not drawn
constexpr double kEvaluation = 0x1p-30;     // [pixels]: above the rounding of what is computed near the buffer

/// What projecting a cluster's vertices told.
struct Projected {
    Extent extent;        ///< of those before the eye
    bool regular = true;  ///< all lie before the eye, and none too far away
};

/// Projects a cluster's vertices into px, py, pd; those before the near guard get a NaN.
Projected projectVertices(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, double* px,
                          double* py, double* pd) {
    const D8 d;
    const hn::Rebind<float, D8> f;
    const auto row = [&](const glm::dvec4& r, auto x, auto y, auto z) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(hn::Set(d, r.x), x), hn::Mul(hn::Set(d, r.y), y)),
                       hn::Add(hn::Mul(hn::Set(d, r.z), z), hn::Set(d, r.w)));
    };
    const auto guard = hn::Set(d, object.near_guard);
    const auto behind = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
    const auto most = hn::Set(d, 1e300), limit = hn::Set(d, kFarthestCorner);
    auto x0 = most, y0 = most, x1 = hn::Neg(most), y1 = x1, nearest = x1;
    const float *xs = occluder.x.data() + cluster.first_vertex, *ys = occluder.y.data() + cluster.first_vertex,
                *zs = occluder.z.data() + cluster.first_vertex;
    Projected out;
    for (size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(d)) {
        const auto x = hn::PromoteTo(d, hn::LoadU(f, xs + i));
        const auto y = hn::PromoteTo(d, hn::LoadU(f, ys + i));
        const auto z = hn::PromoteTo(d, hn::LoadU(f, zs + i));
        const auto w = row(object.w, x, y, z);
        const auto drawn = hn::And(hn::Ge(row(object.near, x, y, z), guard), hn::Gt(w, hn::Zero(d)));
        const auto inverse = hn::Div(hn::Set(d, 1.0), w);
        const auto sx = hn::IfThenElse(drawn, hn::Mul(row(object.x, x, y, z), inverse), behind);
        const auto sy = hn::Mul(row(object.y, x, y, z), inverse), sd = hn::Mul(row(object.d, x, y, z), inverse);
        hn::StoreU(sx, d, px + i);
        hn::StoreU(sy, d, py + i);
        hn::StoreU(sd, d, pd + i);
        // False for a NaN, too.
        const auto fine = hn::And(hn::Lt(hn::Abs(sx), limit), hn::Lt(hn::Abs(sy), limit));
        if (!hn::AllTrue(d, fine)) out.regular = false;
        x0 = hn::Min(x0, hn::IfThenElse(fine, sx, most));
        y0 = hn::Min(y0, hn::IfThenElse(fine, sy, most));
        x1 = hn::Max(x1, hn::IfThenElse(fine, sx, hn::Neg(most)));
        y1 = hn::Max(y1, hn::IfThenElse(fine, sy, hn::Neg(most)));
        nearest = hn::Max(nearest, hn::IfThenElse(fine, sd, hn::Neg(most)));
    }
    out.extent.x0 = hn::GetLane(hn::MinOfLanes(d, x0));
    out.extent.y0 = hn::GetLane(hn::MinOfLanes(d, y0));
    out.extent.x1 = hn::GetLane(hn::MaxOfLanes(d, x1));
    out.extent.y1 = hn::GetLane(hn::MaxOfLanes(d, y1));
    out.extent.nearest = hn::GetLane(hn::MaxOfLanes(d, nearest));
    return out;
}

/// A cluster on its way to the tiles.
struct ClusterDraw {
    DepthTiles& tiles;
    const Screen& object;
    const DrawnCluster& drawn;
    const OccluderCluster& cluster;
    const OccluderPolygon* polygons;
    const double *x, *y, *d;  ///< projected vertices
    int8_t front;             ///< which way front faces wind on the screen: 1 counter-clockwise, -1 clockwise
};

constexpr int kMaxAtOnce = 256;

/// Twice the signed area of a polygon whose corners all have an image.
HWY_INLINE double areaOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
    const uint8_t* v = polygon.vertex;
    const bool quad = v[3] != OccluderPolygon::kNone;
    const uint8_t a = v[0], b = v[1], e = v[2], f = quad ? v[3] : v[0];
    // By its diagonals; in a triangle one of them is a side.
    return (c.x[e] - c.x[a]) * (c.y[f] - c.y[b]) - (c.x[f] - c.x[b]) * (c.y[e] - c.y[a]);
}

/// Which way a polygon winds that is not wholly in front of the near plane: by homogeneous coordinates, of which only
/// the sign means something.
double windingOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
    const Occluder& o = *c.drawn.occluder;
    const auto clip = [&](int i) {
        const size_t at = size_t{c.cluster.first_vertex} + polygon.vertex[i];
        const glm::dvec4 p(o.x[at], o.y[at], o.z[at], 1.0);
        return glm::dvec3(glm::dot(c.object.x, p), glm::dot(c.object.y, p), glm::dot(c.object.w, p));
    };
    const double first = glm::dot(clip(0), glm::cross(clip(1), clip(2)));
    return first != 0.0 || polygon.corners() == 3 ? first : glm::dot(clip(0), glm::cross(clip(2), clip(3)));
}

/// How a polygon stands to the near plane and to the border of what can be drawn.
enum class Place : uint8_t { kRegular, kCut, kUndrawn };

Place placeOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
    int before = 0;
    for (int i = 0; i < polygon.corners(); ++i) {
        const uint8_t v = polygon.vertex[i];
        if (std::isnan(c.x[v])) ++before;
        else if (!(std::abs(c.x[v]) < kFarthestCorner && std::abs(c.y[v]) < kFarthestCorner)) return Place::kUndrawn;
    }
    return before == 0 ? Place::kRegular : before < polygon.corners() && c.drawn.clips ? Place::kCut : Place::kUndrawn;
}

/// Gathers the corners of a polygon whose corners all have an image.
HWY_INLINE Corners cornersOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
    Corners out;
    out.count = polygon.corners();
    for (int i = 0; i < out.count; ++i) {
        const uint8_t v = polygon.vertex[i];
        out.x[i] = c.x[v];
        out.y[i] = c.y[v];
        out.d[i] = c.d[v];
    }
    return out;
}

/// Of a polygon that the near plane cuts; without corners if something is too far away.
Corners cutCorners(const ClusterDraw& c, const OccluderPolygon& polygon) {
    ClippedPolygon clipped;
    Corners out;
    if (!clipAtNear(c.object, *c.drawn.occluder, c.cluster, polygon.vertex, polygon.corners(), clipped)) return out;
    for (int i = 0; i < clipped.count; ++i) {
        if (!(std::abs(clipped.x[i]) < kFarthestCorner && std::abs(clipped.y[i]) < kFarthestCorner)) return out;
        out.x[i] = clipped.x[i];
        out.y[i] = clipped.y[i];
        out.d[i] = clipped.d[i];
    }
    out.count = clipped.count;
    return out;
}

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

Patch makePatch(const ClusterDraw& c) {
    return {c.tiles, c.drawn.position_error + kEvaluation, c.drawn.position_error, c.drawn.depth_error};
}

/// Draws the polygons of a joined cluster that wind one way.
/// @returns whether seams are left
bool drawJoined(const ClusterDraw& c, const Projected& projected, const Windings& windings, const CutEdges* cuts,
                int8_t turn, uint32_t source) {
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
        const bool cut = windings.place[p] == Place::kCut;
        const Corners corners = cut ? cutCorners(c, c.polygons[p]) : cornersOf(c, c.polygons[p]);
        if (corners.count >= 3) addDepth(patch, corners, turn);
    }
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
    addOpenEdges(patch, open);
    return coverPatch(patch, source | SeamEntry::kAllPolygons);
}

/// Draws each polygon of a loose cluster by itself.
bool drawLoose(const ClusterDraw& c, const Windings& windings, int8_t turn, uint32_t source) {
    bool seams = false;
    OpenEdges open;
    for (int p = 0; p < windings.count; ++p) {
        if (windings.turn[p] != turn) continue;
        const bool cut = windings.place[p] == Place::kCut;
        const Corners corners = cut ? cutCorners(c, c.polygons[p]) : cornersOf(c, c.polygons[p]);
        if (corners.count < 3) continue;
        Extent extent;
        for (int i = 0; i < corners.count; ++i) extent.grow(corners.x[i], corners.y[i], corners.d[i]);
        Patch patch = makePatch(c);
        if (!beginPatch(patch, extent)) continue;
        addDepth(patch, corners, turn);
        open.count = 0;
        for (int i = 0; i < corners.count; ++i) {
            const int j = i + 1 < corners.count ? i + 1 : 0;
            open.add(corners.x[i], corners.y[i], corners.x[j], corners.y[j], turn);
        }
        addOpenEdges(patch, open);
        seams |= coverPatch(patch, source | static_cast<uint32_t>(p));
    }
    return seams;
}

void drawClusterKernel(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    const size_t first = tiles.px.size(), padded = (source.vertex_count + 7u) / 8 * 8;
    tiles.px.resize(first + padded);
    tiles.py.resize(first + padded);
    tiles.pd.resize(first + padded);
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
    Windings windings;
    windPolygons(c, projected.regular, windings);
    const bool loose = source.edge_count == 0 || source.edge_count + kMaxAtOnce > OpenEdges::kMost;
    bool kept = false;
    const auto drawTurn = [&](int8_t turn, const CutEdges* cuts) {
        if ((turn > 0 ? windings.forward : windings.backward) == 0) return;
        const uint32_t name = static_cast<uint32_t>(tiles.drawn.size()) << 8;
        const bool seams =
            loose ? drawLoose(c, windings, turn, name) : drawJoined(c, projected, windings, cuts, turn, name);
        if (!seams) return;
        DrawnCluster& record = tiles.drawn.emplace_back(cluster);
        record.first_vertex = static_cast<uint32_t>(first);
        record.clockwise = turn < 0;
        if (!projected.regular) {
            record.object = static_cast<uint32_t>(tiles.objects.size());
            tiles.objects.push_back(object);
        }
        kept = true;
    };
    if (projected.regular || loose) {
        drawTurn(c.front, nullptr);
        drawTurn(static_cast<int8_t>(-c.front), nullptr);
    } else {
        const CutEdges cuts(c, windings);
        drawTurn(c.front, &cuts);
        drawTurn(static_cast<int8_t>(-c.front), &cuts);
    }
    if (kept) return;
    tiles.px.resize(first);
    tiles.py.resize(first);
    tiles.pd.resize(first);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawClusterKernel);

void drawCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    HWY_DYNAMIC_DISPATCH(drawClusterKernel)(tiles, cluster, object, flips);
}

}  // namespace sightline
#endif  // HWY_ONCE
