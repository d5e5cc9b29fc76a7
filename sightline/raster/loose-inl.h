// Draws loose clusters: their polygons share no sides, so each covers by itself the pixels that lie inside all its sides.
// SPDX-License-Identifier: MIT
//
// The argument for a polygon drawn alone. A pixel is covered if it lies on the inner side of each side's line, farther
// from it than all errors. Seen from a point of it each side then turns the same way, so the winding number is 1 or more;
// and moving the corners within their errors moves no side over it. So it holds for polygons that are not convex, too.
//
// Small polygons are classified by the batch, and leave no seams unless all detail is wanted: in a soup nothing closes
// them, and resolving them costs more than all else.
#if defined(SIGHTLINE_RASTER_LOOSE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RASTER_LOOSE_INL_H
#undef SIGHTLINE_RASTER_LOOSE_INL_H
#else
#define SIGHTLINE_RASTER_LOOSE_INL_H
#endif

#include "sightline/raster/cluster_draw-inl.h"
#include "sightline/raster/small_polygons-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kMostSlack = 1.0 / 16.0;  // [pixels]: vertices known less exactly from floats are projected in doubles
constexpr uint32_t kPanels = 4;            // polygons: a cluster of no more may be a wall's panels
constexpr double kLargeSides = 128.0;  // [pixels]: width and height of a polygon that keeps its seams in any cluster

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
/// @param task  gets the errors' bounds
/// @returns false if those are too large
inline bool projectSnapped(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster,
                           const DrawnCluster& drawn, SnappedVertex* out, SmallPolygonsTask& task) {
    const F8 f;
    const hn::Rebind<int32_t, F8> i32;
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
    for (size_t v = 0; v < cluster.vertex_count; v += hn::Lanes(f)) {
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
    // A small polygon that is drawn lies near the buffer: x/w there is wrong by (ex + |x/w| ew) / w, and two roundings.
    const double w = hn::GetLane(hn::MinOfLanes(f, w_least)) - w_row.error;
    const double d = hn::GetLane(hn::MaxOfLanes(f, d_most));
    const double place = 8.0 * std::max(task.columns, task.rows) + 64.0;
    const double error = std::max(x_row.error, y_row.error) + place * w_row.error;
    const double slack = error / w + place * 0x1p-22 + drawn.position_error;
    const double d_error = ((object.perspective ? 0.0 : d_row.error) + d * w_row.error) / w + d * 0x1p-22;
    task.slack = rounded_up(slack);
    task.depth_error = rounded_up(d_error + drawn.depth_error);
    return slack < kMostSlack;
}

/// coverPixels() for tiles that are not to have blocks, without a jump that depends on depths: those are as random as the
/// polygons' order. The layer lies in front of the base, or there is none.
HWY_INLINE void coverMasked(DepthTiles& tiles, uint32_t tile, uint64_t mask, float z) {
    if (!(z > tiles.base[tile])) return;
    const float layer = tiles.layer[tile];
    const bool has_layer = layer > DepthTiles::kOpen;
    const uint64_t old = has_layer ? tiles.layer_mask[tile] : 0, both = old | mask;
    if (both == ~uint64_t{0} || (has_layer && tiles.block[tile] != DepthTiles::kNone))
        return coverPixels(tiles, tile, mask, z);
    const bool front = z > layer;
    const float nearer = front ? z : layer, farther = front ? layer : z;
    const uint64_t near_mask = front ? mask : old;
    const bool says_it_all = both == near_mask;
    tiles.layer[tile] = says_it_all ? nearer : farther;
    tiles.layer_mask[tile] = both;  // the nearer one's if that says it all
    tiles.block[tile] = DepthTiles::kNone;
}

/// Carries classified polygons into the tiles.
inline void coverSmall(DepthTiles& tiles, const SmallPolygons& small) {
    for (uint32_t r = 0; r < small.count; ++r)
        coverMasked(tiles, small.tile(r), small.inner[r], small.farthest[small.polygon(r)]);
}

/// The spans of a row of tiles: per row of pixels the first one and the one after the last.
struct PixelSpans {
    alignas(32) int32_t first[8], end[8];
    int32_t column0, column1;  ///< tiles that they meet; none if column0 > column1

    HWY_INLINE uint64_t inTile(int32_t tile) const {
        const hn::CappedTag<int32_t, 8> i32;
        const hn::Rebind<uint8_t, decltype(i32)> u8;
        const auto none = hn::Zero(i32), eight = hn::Set(i32, 8), ones = hn::Set(i32, 0xff);
        alignas(8) uint8_t bytes[8];
        for (size_t k = 0; k < 8; k += hn::Lanes(i32)) {
            const auto from = hn::Sub(hn::Load(i32, first + k), hn::Set(i32, 8 * tile));
            const auto to = hn::Sub(hn::Load(i32, end + k), hn::Set(i32, 8 * tile));
            const auto bits = hn::AndNot(hn::Shl(ones, hn::Min(hn::Max(to, none), eight)),
                                         hn::And(hn::Shl(ones, hn::Min(hn::Max(from, none), eight)), ones));
            hn::StoreU(hn::DemoteTo(u8, bits), u8, bytes + k);
        }
        uint64_t word;
        std::memcpy(&word, bytes, sizeof word);
        return word;
    }
};

/// A polygon drawn alone: its sides, counted from the lower left corner of the tiles that it may meet.
struct LonePolygon {
    double x[Corners::kMax], slope[Corners::kMax];  ///< at the centre of the lowest row; change per row
    float wide[Corners::kMax];                      ///< half of what it may touch of a row of pixels, with all errors
    bool on_left[Corners::kMax];
    int sides = 0;                         ///< those that are not level
    double inner_low, inner_high;          ///< y between which level sides leave something inside
    double low, high, x_least, x_most;     ///< bounds of the corners
    double reach;                          ///< bound on the error of a corner  [pixels]
    int32_t column0, row0, columns, rows;  ///< [tiles]

    inline void addSide(double ax, double ay, double bx, double by, int turn);
    template <bool kOuter>
    inline void spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const;
};

inline void LonePolygon::addSide(double ax, double ay, double bx, double by, int turn) {
    const Line line(ax, ay, bx, by);
    if (!line.level) {
        const int i = sides++;
        on_left[i] = (by < ay) == (turn > 0);
        slope[i] = line.slope;
        x[i] = line.x + (0.5 - line.y) * line.slope;
        // Float adds its own: a few steps of what is computed at any row.
        const double tilt = std::abs(line.slope), all = std::abs(x[i]) + 8.0 * (rows + 1) * tilt;
        const double error = line.error() + std::abs(line.x) * 0x1p-50;
        wide[i] = static_cast<float>(tilt * (0.5 + reach) + reach + error + 0x1p-20 * (all + error));
        return;
    }
    // How far the line itself may rise or fall between the polygon's left and right end.
    if (ax == bx && ay == by) return;
    const double rise = line.height == 0.0 ? 0.0 : line.height * ((x_most - x_least) / std::abs(bx - ax));
    if ((bx > ax) == (turn > 0) || !(rise < 1e9))
        inner_low = std::max(inner_low, std::max(ay, by) + rise + kEvaluation);
    if ((bx < ax) == (turn > 0) || !(rise < 1e9))
        inner_high = std::min(inner_high, std::min(ay, by) - rise - kEvaluation);
}

/// @tparam kOuter  also those of pixels that it may touch
template <bool kOuter>
inline void LonePolygon::spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const {
    const F8 d;
    const hn::Rebind<int32_t, F8> i32;
    const float width = static_cast<float>(8 * columns);
    const float edge = 0x1p-20f * width;
    const float left = static_cast<float>(std::max(x_least, -1.0)),
                right = static_cast<float>(std::min(x_most, width + 1.0));
    const float e = static_cast<float>(reach) * (1.0f + 0x1p-20f);
    const auto zero = hn::Zero(d), beyond = hn::Set(d, width), one = hn::Set(d, 1.0f);
    const auto far = hn::Set(i32, 1 << 20);
    auto least = far, most = hn::Neg(far), outer_least = far, outer_most = most;
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto rows_up = hn::Iota(d, static_cast<float>(k));
        auto low = hn::Set(d, left + e + edge), high = hn::Set(d, right - e - edge);
        auto outer_low = hn::Set(d, left - e - edge), outer_high = hn::Set(d, right + e + edge);
        for (int i = 0; i < sides; ++i) {
            const float start = static_cast<float>(x[i] + 8.0 * row * slope[i]), s = static_cast<float>(slope[i]);
            const auto at = hn::Add(hn::Set(d, start), hn::Mul(hn::Set(d, s), rows_up)), half = hn::Set(d, wide[i]);
            if (on_left[i]) {
                low = hn::Max(low, hn::Add(at, half));
                if (kOuter) outer_low = hn::Max(outer_low, hn::Sub(at, half));
            } else {
                high = hn::Min(high, hn::Sub(at, half));
                if (kOuter) outer_high = hn::Min(outer_high, hn::Add(at, half));
            }
        }
        const auto whole = [&](auto v) HWY_ATTR { return hn::ConvertTo(i32, hn::Min(hn::Max(v, zero), beyond)); };
        const auto note = [&](PixelSpans& to, auto first, auto end, auto& lowest, auto& highest) HWY_ATTR {
            hn::Store(first, i32, to.first + k);
            hn::Store(end, i32, to.end + k);
            const auto some = hn::Lt(first, end);
            lowest = hn::Min(lowest, hn::IfThenElse(some, first, lowest));
            highest = hn::Max(highest, hn::IfThenElse(some, end, highest));
        };
        note(inner, whole(hn::Add(low, one)), whole(high), least, most);
        if (kOuter) note(outer, whole(outer_low), whole(hn::Add(outer_high, one)), outer_least, outer_most);
    }
    const auto close = [&](PixelSpans& to, auto lowest, auto highest) HWY_ATTR {
        to.column0 = hn::GetLane(hn::MinOfLanes(i32, lowest)) >> 3;
        to.column1 = (hn::GetLane(hn::MaxOfLanes(i32, highest)) - 1) >> 3;
    };
    close(inner, least, most);
    if (kOuter) close(outer, outer_least, outer_most);
}

/// How near a polygon is in the tiles.
struct LoneDepth {
    BufferPlane plane;
    bool planar = false;
    uint32_t index = DepthTiles::kNone;  ///< of the plane, once a tile needs it
    double tilt = 0;
    float floor = 0, nearest = 0;

    HWY_INLINE float in(int32_t column, int32_t row) const {
        if (!planar) return floor;
        const double center = plane.d0 + plane.dx * (8.0 * column + 4.0) + plane.dy * (8.0 * row + 4.0);
        const double error = plane.error + 0x1p-20 * (std::abs(center) + 8.0 * tilt);
        return std::max(static_cast<float>(center - 4.0 * tilt - error), plane.floor);
    }
};

/// Whether any tile of a rectangle does not hide what is no nearer.
HWY_INLINE bool anyOpen(const DepthTiles& tiles, const LonePolygon& p, float nearest) {
    const F16 d;
    for (int32_t row = 0; row < p.rows; ++row) {
        const float* base = tiles.base.data() + size_t{static_cast<uint32_t>(p.row0 + row)} * tiles.stride +
                            static_cast<size_t>(p.column0);
        for (int32_t i = 0; i < p.columns; i += static_cast<int32_t>(hn::Lanes(d))) {
            const auto open = hn::Lt(hn::LoadU(d, base + i), hn::Set(d, nearest));
            if (!hn::AllFalse(d, hn::And(hn::FirstN(d, static_cast<size_t>(p.columns - i)), open))) return true;
        }
    }
    return false;
}

/// Carries a polygon into the tiles, row by row. Returns whether it left seams.
template <bool kSeams>
inline bool coverLone(DepthTiles& tiles, const LonePolygon& p, LoneDepth& depth, uint32_t source) {
    PixelSpans inner, outer;
    bool seams = false;
    const double limit = 8.0 * p.rows;
    const auto rowOf = [&](double y) { return static_cast<int32_t>(std::clamp(y, -1.0, limit)); };
    const int32_t in_first = rowOf(std::ceil(p.inner_low + p.reach)),
                  in_end = rowOf(std::floor(p.inner_high - p.reach));
    const int32_t out_first = rowOf(std::floor(p.low - p.reach)), out_last = rowOf(std::floor(p.high + p.reach));
    for (int32_t row = 0; row < p.rows; ++row) {
        const uint64_t in_rows =
            bytesBetween(std::clamp(in_first - 8 * row, -8, 15), std::clamp(in_end - 1 - 8 * row, -8, 15));
        if (!kSeams && !in_rows) continue;
        const uint64_t out_rows =
            bytesBetween(std::clamp(out_first - 8 * row, -8, 15), std::clamp(out_last - 8 * row, -8, 15));
        p.spans<kSeams>(row, inner, outer);
        const uint32_t at = static_cast<uint32_t>(p.row0 + row) * tiles.stride + static_cast<uint32_t>(p.column0);
        const PixelSpans& all = kSeams ? outer : inner;
        const int32_t last = std::min(all.column1, p.columns - 1);
        for (int32_t column = all.column0; column <= last; ++column) {
            const uint32_t tile = at + static_cast<uint32_t>(column);
            if (!(tiles.base[tile] < depth.nearest)) continue;
            const uint64_t covered = inner.inTile(column) & in_rows;
            if (covered) {
                const float z = depth.in(p.column0 + column, p.row0 + row);
                if (covered != ~uint64_t{0}) {
                    if (tiles.detail == Detail::kMasked) coverMasked(tiles, tile, covered, z);
                    else coverPixels(tiles, tile, covered, z);
                } else {
                    if (depth.planar && depth.index == DepthTiles::kNone) {
                        depth.index = static_cast<uint32_t>(tiles.planes.size());
                        tiles.planes.push_back(depth.plane);
                    }
                    coverWhole(tiles, tile, z, depth.index);
                }
            }
            if (!kSeams) continue;
            const uint64_t touched = outer.inTile(column) & out_rows & ~covered;
            if (const uint64_t seam = touched ? notYetNearer(tiles, tile, touched, depth.nearest) : 0) {
                addSeam(tiles, tile, seam, source);
                seams = true;
            }
        }
    }
    return seams;
}

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
    LonePolygon p;
    const double far = std::max(std::max(std::abs(x0), std::abs(x1)), std::max(std::abs(y0), std::abs(y1)));
    const double e = p.reach = c.drawn.position_error + kEvaluation + far * 0x1p-48;
    if (!(x1 + e >= 0 && y1 + e >= 0 && x0 - e < tiles.width && y0 - e < tiles.height)) return false;
    const auto tileOf = [](double at, double size) {
        return static_cast<int32_t>(std::clamp(at, 0.0, size - 1.0)) >> 3;
    };
    p.column0 = tileOf(x0 - e, tiles.width);
    p.row0 = tileOf(y0 - e, tiles.height);
    p.columns = tileOf(x1 + e, tiles.width) - p.column0 + 1;
    p.rows = tileOf(y1 + e, tiles.height) - p.row0 + 1;
    LoneDepth depth;
    const double near = d1 + std::abs(d1) * 0x1p-22 + c.drawn.depth_error;
    depth.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    if (!anyOpen(tiles, p, depth.nearest)) return false;
    const double corner_error = std::max(std::abs(d0), std::abs(d1)) * 0x1p-36 + c.drawn.depth_error;
    depth.floor = static_cast<float>(d0 - corner_error - std::abs(d0) * 0x1p-22);
    const double flat = p.columns <= 2 && p.rows <= 2 ? 0.01 : 0x1p-10;
    if (d1 - d0 > flat * std::abs(d0)) {
        depth.planar = planeOf(k, c.drawn.depth_error, c.drawn.position_error, depth.plane);
        depth.plane.floor = depth.floor;
        depth.tilt = std::abs(depth.plane.dx) + std::abs(depth.plane.dy);
    }
    const double left = 8.0 * p.column0, bottom = 8.0 * p.row0;
    p.x_least = x0 - left;
    p.x_most = x1 - left;
    p.low = p.inner_low = y0 - bottom;
    p.high = p.inner_high = y1 - bottom;
    for (int i = 0; i < k.count; ++i) {
        const int j = i + 1 < k.count ? i + 1 : 0;
        p.addSide(k.x[i] - left, k.y[i] - bottom, k.x[j] - left, k.y[j] - bottom, turn);
    }
    const bool seams = panel || x1 - x0 + y1 - y0 >= kLargeSides;
    return seams ? coverLone<true>(tiles, p, depth, source) : coverLone<false>(tiles, p, depth, source);
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

/// Draws the small polygons of a loose cluster together; the others remain in `small.large`.
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
    if (!projectSnapped(object, *cluster.occluder, source, cluster, vertices, task)) {
        double x[OccluderCluster::kMaxVertices], y[OccluderCluster::kMaxVertices], d[OccluderCluster::kMaxVertices];
        projectVertices(object, *cluster.occluder, source, x, y, d);
        snapVertices(x, y, d, source.vertex_count, vertices);
        task.slack = static_cast<float>((cluster.position_error + kEvaluation) * (1.0 + 0x1p-20));
        task.depth_error = static_cast<float>(cluster.depth_error * (1.0 + 0x1p-20));
    }
    classifySmallPolygons<false>(task, small);
    coverSmall(tiles, small);
}

/// Draws a loose cluster; see drawCluster().
inline void drawLooseCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    const int8_t front = flips != object.mirrored ? -1 : 1;
    const uint32_t polygons = source.polygon_count + source.ring_count;
    const bool panels = tiles.detail == Detail::kFull || polygons <= kPanels || source.ring_count > 0;
    SmallPolygons small;
    const bool together = !panels && polygons <= OccluderCluster::kMaxLoose;
    if (together) {
        drawSmall(tiles, cluster, object, front < 0, small);
        if (small.large_count == 0) return;
    }
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
                        front};
    LoneList list;
    if (together)
        for (uint32_t i = 0; i < small.large_count; ++i) list.add(c, projected.regular, small.large[i]);
    else
        for (uint32_t p = 0; p < polygons; ++p) list.add(c, projected.regular, p);
    bool kept = false;
    for (const int8_t turn : {front, static_cast<int8_t>(-front)}) {
        const uint32_t name = static_cast<uint32_t>(tiles.drawn.size()) << 8;
        bool seams = false;
        for (int i = 0; i < list.count; ++i) {
            if (list.turn[i] != turn) continue;
            const OccluderPolygon& polygon = c.polygons[list.polygon[i]];
            const Corners corners = list.cut[i] ? cutCorners(c, polygon) : cornersOf(c, polygon);
            if (corners.count >= 3) seams |= drawLone(c, corners, turn, panels, name | list.polygon[i]);
        }
        if (!seams) continue;
        keepDrawn(c, turn, first, projected.regular);
        kept = true;
    }
    if (kept) return;
    tiles.px.resize(first);
    tiles.py.resize(first);
    tiles.pd.resize(first);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
