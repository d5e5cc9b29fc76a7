// What drawing a joined and a loose cluster share: projection, how a polygon stands to the screen, its corners.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_CLUSTER_DRAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_CLUSTER_DRAW_INL_H
#undef SIGHTLINE_BUFFER_DRAW_CLUSTER_DRAW_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_CLUSTER_DRAW_INL_H
#endif

#include <cmath>
#include <limits>

#include "sightline/buffer/near_clip.h"
#include "sightline/buffer/draw/patch_cover-inl.h"

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
inline Projected projectVertices(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster,
                                 double* px, double* py, double* pd) {
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

/// Makes room for a cluster's vertices behind those that are kept: where they begin in DepthTiles::px, py, pd.
inline size_t roomForVertices(DepthTiles& tiles, const OccluderCluster& cluster) {
    const size_t first = tiles.vertex_count, end = first + (cluster.vertex_count + 7u) / 8 * 8;
    if (tiles.px.size() < end)
        for (Array<double>* array : {&tiles.px, &tiles.py, &tiles.pd}) array->resize(2 * end);
    return first;
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
inline double windingOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
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

inline Place placeOf(const ClusterDraw& c, const OccluderPolygon& polygon) {
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
inline Corners cutCorners(const ClusterDraw& c, const OccluderPolygon& polygon) {
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

inline Patch makePatch(const ClusterDraw& c) {
    return {c.tiles, c.drawn.position_error + kEvaluation + c.tiles.gap, c.drawn.position_error, c.drawn.depth_error};
}

/// Keeps what seams need of a cluster's polygons that wind one way, its vertices with them.
/// @param first  roomForVertices()
inline void keepDrawn(const ClusterDraw& c, int8_t turn, size_t first, bool regular) {
    DrawnCluster& record = c.tiles.drawn.emplace_back(c.drawn);
    record.first_vertex = static_cast<uint32_t>(first);
    record.clockwise = turn < 0;
    record.backs = turn != c.front;
    c.tiles.vertex_count = first + (c.cluster.vertex_count + 7u) / 8 * 8;
    if (regular) return;
    record.object = static_cast<uint32_t>(c.tiles.objects.size());
    c.tiles.objects.push_back(c.object);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
