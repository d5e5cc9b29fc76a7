// Draws loose clusters: small polygons by the batch, the others one by one.
// SPDX-License-Identifier: MIT
//
// Small polygons are classified by the batch, and leave no seams unless all detail is wanted: in a soup nothing closes
// them, and resolving them costs more than all else.
#include "sightline/buffer/draw/loose.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/ablate.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/draw/loose.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/lone_polygon-inl.h"
#include "sightline/buffer/draw/small_classify-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kMostSlack = 1.0 / 16.0;  // [pixels]: vertices known less exactly from floats are projected in doubles
constexpr uint32_t kPanels = 4;            // polygons: a cluster of no more may be a wall's panels

/// Floats of one row of the screen map, from a cluster's centre.
struct CenteredRow {
    float factor[3], constant;
    double error;  ///< bound on all roundings of a value of the row

    /// @param extent  from the centre to the farthest vertex, per axis
    CenteredRow(const glm::dvec4& row, const glm::dvec3& center, const glm::dvec3& extent) {
        const double at = row.x * center.x + row.y * center.y + row.z * center.z + row.w;
        constant = static_cast<float>(at);
        double far = std::abs(row.w), near = std::abs(at);
        for (int axis = 0; axis < 3; ++axis) {
            factor[axis] = static_cast<float>(row[axis]);
            far += std::abs(row[axis] * center[axis]);
            near += std::abs(row[axis]) * extent[axis];
        }
        // Six roundings of 2^-24 on the way of each term; and those of the constant in doubles.
        error = near * 0x1p-21 + far * 0x1p-48;
    }
};

/// Projects a cluster's vertices in floats.
/// @param f     vectors of it hold no more than the cluster's vertices, which are padded to a multiple of eight
/// @param task  gets the errors' bounds
/// @returns false if those are too large
template <class F>
inline bool projectSnapped(F f, const Screen& object, const Occluder& occluder, const OccluderCluster& cluster,
                           const DrawnCluster& drawn, SnappedVertex* out, SmallPolygonsTask& task) {
    const hn::Rebind<int32_t, F> i32;
    const Box3f& box = cluster.bounds;
    glm::dvec3 center, extent;
    for (int axis = 0; axis < 3; ++axis) {
        const float middle = static_cast<float>(0.5 * (double{box.min[axis]} + box.max[axis]));
        center[axis] = middle;
        extent[axis] = std::max(double{box.max[axis]} - middle, double{middle} - box.min[axis]);
    }
    const CenteredRow x_row(object.x, center, extent), y_row(object.y, center, extent), w_row(object.w, center, extent),
        d_row(object.d, center, extent), near_row(object.near, center, extent);
    const auto cx = hn::Set(f, static_cast<float>(center.x)), cy = hn::Set(f, static_cast<float>(center.y)),
               cz = hn::Set(f, static_cast<float>(center.z));
    const auto row = [&](const CenteredRow& r, auto x, auto y, auto z) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(hn::Set(f, r.factor[0]), x), hn::Mul(hn::Set(f, r.factor[1]), y)),
                       hn::Add(hn::Mul(hn::Set(f, r.factor[2]), z), hn::Set(f, r.constant)));
    };
    const auto rounded_up = [](double v) { return static_cast<float>(v * (1.0 + 0x1p-22)); };
    const auto guard = hn::Set(f, rounded_up(object.near_guard + near_row.error));
    const auto least_w = hn::Set(f, rounded_up(2.0 * w_row.error));
    const auto most = hn::Set(f, 3e38f), one = hn::Set(f, 1.0f), limit = hn::Set(f, 0x1p24f);
    const auto fine = hn::Set(f, 256.0f), farthest = hn::Set(f, static_cast<float>(SnappedVertex::kFarthest));
    auto w_least = most, d_most = hn::Zero(f);
    const float *xs = occluder.x.data() + cluster.first_vertex, *ys = occluder.y.data() + cluster.first_vertex,
                *zs = occluder.z.data() + cluster.first_vertex;
    const size_t end = (cluster.vertex_count + 7u) / 8 * 8 - hn::Lanes(f);
    for (size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(f)) {
        const size_t v = std::min(i, end);  // the last ones once more, rather than what lies behind them
        const auto x = hn::Sub(hn::LoadU(f, xs + v), cx), y = hn::Sub(hn::LoadU(f, ys + v), cy);
        const auto z = hn::Sub(hn::LoadU(f, zs + v), cz);
        const auto w = row(w_row, x, y, z), inverse = hn::Div(one, w);
        const auto px = hn::Mul(row(x_row, x, y, z), inverse), py = hn::Mul(row(y_row, x, y, z), inverse);
        const auto pd = object.perspective ? inverse : hn::Mul(row(d_row, x, y, z), inverse);
        // False for a NaN, too.
        const auto before = hn::And(hn::Ge(row(near_row, x, y, z), guard), hn::Gt(w, least_w));
        const auto good = hn::And(before, hn::And(hn::Lt(hn::Abs(px), limit), hn::Lt(hn::Abs(py), limit)));
        w_least = hn::Min(w_least, hn::IfThenElse(good, w, most));
        d_most = hn::Max(d_most, hn::IfThenElseZero(good, hn::Abs(pd)));
        const auto snap = [&](auto p) HWY_ATTR {
            return hn::NearestInt(
                hn::Min(hn::Max(hn::Mul(hn::IfThenElseZero(good, p), fine), hn::Neg(farthest)), farthest));
        };
        const auto sx = hn::IfThenElse(hn::RebindMask(i32, good), snap(px), hn::Set(i32, SnappedVertex::kNone));
        hn::StoreInterleaved4(sx, snap(py), hn::BitCast(i32, hn::IfThenElseZero(good, pd)), hn::Zero(i32), i32,
                              &out[v].x);
    }
    // A polygon that is drawn from here lies near the buffer: x/w there is wrong by (ex + |x/w| ew) / w, and by two
    // roundings.
    const double w = hn::GetLane(hn::MinOfLanes(f, w_least)) - w_row.error;
    const double d = hn::GetLane(hn::MaxOfLanes(f, d_most));
    const double place = 8.0 * std::max(task.columns, task.rows) + 2.0 * kLargeSides;
    const double error = std::max(x_row.error, y_row.error) + place * w_row.error;
    const double slack = error / w + place * 0x1p-22 + drawn.position_error;
    const double d_error = ((object.perspective ? 0.0 : d_row.error) + d * w_row.error) / w + d * 0x1p-22;
    task.slack = rounded_up(slack);
    task.depth_error = rounded_up(d_error + drawn.depth_error);
    return slack < kMostSlack;
}

/// Carries classified polygons into the tiles.
inline void coverSmall(DepthTiles& tiles, const SmallPolygons& small) {
    if (tiles.detail == Detail::kFull) {
        for (uint32_t r = 0; r < small.count; ++r)
            if (small.inner[r]) coverPixels(tiles, small.tile(r), small.inner[r], small.farthest[small.polygon(r)]);
        return;
    }
    const MaskedTiles masked(tiles);
    for (uint32_t r = 0; r < small.count; ++r)
        masked.cover(small.tile(r), small.inner[r], small.farthest[small.polygon(r)]);
}

/// Which polygons of a loose cluster are drawn one by one, and which way they wind.
struct LoneList {
    int count = 0;
    uint8_t polygon[OccluderCluster::kMaxPolygons];
    int8_t turn[OccluderCluster::kMaxPolygons];
    bool cut[OccluderCluster::kMaxPolygons];

    void add(const ClusterDraw& c, bool regular, uint32_t p) {
        const OccluderPolygon& which = c.polygons[p];
        const Place place = regular ? Place::kRegular : placeOf(c, which);
        if (place == Place::kUndrawn) return;
        const double area = place == Place::kRegular ? areaOf(c, which) : windingOf(c, which);
        turn[count] = area > 0.0 ? int8_t{1} : area < 0.0 ? int8_t{-1} : c.front;
        if (turn[count] != c.front && !which.double_sided) return;
        polygon[count] = static_cast<uint8_t>(p);
        cut[count++] = place == Place::kCut;
    }
};

/// Draws the polygons of a loose cluster that leave no seams; the others remain in `small.large`: those of more than a few
/// tiles, and in full detail all but the smallest, which hide most of what their seams would.
inline void drawSmall(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool reverse,
                      SmallPolygons& small) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    SnappedVertex vertices[OccluderCluster::kMaxVertices];
    SmallPolygonsTask task;
    task.polygons = cluster.occluder->polygons.data() + source.first_polygon;
    task.count = source.polygon_count;
    task.vertices = vertices;
    task.columns = tiles.columns;
    task.rows = tiles.rows;
    task.stride = tiles.stride;
    task.reverse = reverse;
    const bool exact = source.vertex_count > 8
                           ? projectSnapped(F16(), object, *cluster.occluder, source, cluster, vertices, task)
                           : projectSnapped(F8(), object, *cluster.occluder, source, cluster, vertices, task);
    if (!exact) {
        double x[OccluderCluster::kMaxVertices], y[OccluderCluster::kMaxVertices], d[OccluderCluster::kMaxVertices];
        projectVertices(object, *cluster.occluder, source, x, y, d);
        snapVertices(x, y, d, source.vertex_count, vertices);
        task.slack = static_cast<float>((cluster.position_error + kEvaluation) * (1.0 + 0x1p-20));
        task.depth_error = static_cast<float>(cluster.depth_error * (1.0 + 0x1p-20));
    }
    classifySmallPolygons<false>(task, small);
    coverSmall(tiles, small);
    uint32_t left = 0;
    for (uint32_t i = 0; i < small.large_count; ++i)
        if (tiles.detail == Detail::kFull || !drawMiddle(tiles, task, task.polygons[small.large[i]]))
            small.large[left++] = small.large[i];
    small.large_count = left;
}

void drawLooseKernel(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    const int8_t front = flips != object.mirrored ? -1 : 1;
    const uint32_t polygons = source.polygon_count + source.ring_count;
    const bool panels = polygons <= kPanels || source.ring_count > 0;
    SmallPolygons small;
    const bool together = !detail::kAblate.batch && !panels && polygons <= OccluderCluster::kMaxLoose;
    if (together) {
        drawSmall(tiles, cluster, object, front < 0, small);
        if (small.large_count == 0) return;
    }
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
                        front};
    LoneList list;
    if (together)
        for (uint32_t i = 0; i < small.large_count; ++i) list.add(c, projected.regular, small.large[i]);
    else
        for (uint32_t p = 0; p < polygons; ++p) list.add(c, projected.regular, p);
    for (const int8_t turn : {front, static_cast<int8_t>(-front)}) {
        const uint32_t name = static_cast<uint32_t>(tiles.drawn.size()) << 8;
        bool seams = false;
        for (int i = 0; i < list.count; ++i) {
            if (list.turn[i] != turn) continue;
            const OccluderPolygon& polygon = c.polygons[list.polygon[i]];
            const Corners corners = list.cut[i] ? cutCorners(c, polygon) : cornersOf(c, polygon);
            if (corners.count >= 3)
                seams |= drawLone(c, corners, turn, panels || tiles.detail == Detail::kFull, name | list.polygon[i]);
        }
        if (!seams) continue;
        keepDrawn(c, turn, first, projected.regular);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawLooseKernel);

void drawLooseCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    HWY_DYNAMIC_DISPATCH(drawLooseKernel)(tiles, cluster, object, flips);
}

}  // namespace sightline
#endif  // HWY_ONCE
