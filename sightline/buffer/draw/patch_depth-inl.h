// The depth of a patch: per tile the farthest of the polygons that touch it, by their planes.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_PATCH_DEPTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_PATCH_DEPTH_INL_H
#undef SIGHTLINE_BUFFER_DRAW_PATCH_DEPTH_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_PATCH_DEPTH_INL_H
#endif

#include "sightline/buffer/covers.h"
#include "sightline/buffer/draw/patch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// A straight line from one point up to another, or along a row.
struct Line {
    double x, y, height, slope;  ///< slope 0 if it is level
    double x_least, x_most;
    bool level;
    bool down;  ///< it was given from its upper end to its lower one

    Line() = default;
    HWY_INLINE Line(double ax, double ay, double bx, double by) {
        const bool up = ay <= by;
        x = up ? ax : bx;
        y = up ? ay : by;
        height = up ? by - ay : ay - by;
        x_least = std::min(ax, bx);
        x_most = std::max(ax, bx);
        level = height < kLevel;
        down = by < ay;
        slope = level ? 0.0 : ((up ? bx - ax : ax - bx) / height);
    }
    HWY_INLINE double at(double above) const { return x + above * slope; }
    /// Bound on the rounding of at(): a few steps of the coordinates, and of heights times the slope.
    HWY_INLINE double error() const {
        return (std::abs(x) + (x_most - x_least)) * 0x1p-48 +
               std::abs(slope) * (std::abs(y) + height + 8192.0) * 0x1p-50;
    }
};

/// A convex polygon's corners on the screen.
struct Corners {
    static constexpr int kMax = 5;
    double x[kMax], y[kMax], d[kMax];
    int count = 0;
};

/// The plane through three of the corners, those that span the greatest area; false if they span too little.
HWY_INLINE bool planeOf(const Corners& c, double depth_error, double position_error, BufferPlane& plane) {
    constexpr double kLeastHeight = 0.125;  // [pixels]
    double best = 0, perimeter = 0;
    int widest = 2;
    for (int i = 2; i < c.count; ++i) {
        const double part =
            std::abs((c.x[i - 1] - c.x[0]) * (c.y[i] - c.y[0]) - (c.x[i] - c.x[0]) * (c.y[i - 1] - c.y[0]));
        if (part > best) {
            best = part;
            widest = i;
        }
    }
    double d_min = c.d[0], d_max = c.d[0];
    for (int i = 0; i < c.count; ++i) {
        const int j = i + 1 < c.count ? i + 1 : 0;
        perimeter += std::abs(c.x[j] - c.x[i]) + std::abs(c.y[j] - c.y[i]);
        d_min = std::min(d_min, c.d[i]);
        d_max = std::max(d_max, c.d[i]);
    }
    if (!(best >= kLeastHeight * perimeter)) return false;
    const int v = widest, u = widest - 1;
    const double area2 = (c.x[u] - c.x[0]) * (c.y[v] - c.y[0]) - (c.x[v] - c.x[0]) * (c.y[u] - c.y[0]);
    const double ux = c.x[u] - c.x[0], uy = c.y[u] - c.y[0], ud = c.d[u] - c.d[0];
    const double vx = c.x[v] - c.x[0], vy = c.y[v] - c.y[0], vd = c.d[v] - c.d[0];
    plane.dx = (ud * vy - vd * uy) / area2;
    plane.dy = (vd * ux - ud * vx) / area2;
    plane.d0 = c.d[0] - plane.dx * c.x[0] - plane.dy * c.y[0];
    // Inside the polygon a barycentric coordinate is wrong by at most three position errors over a height of the
    // triangle, which is kLeastHeight or more: nine such terms, doubled for a quadrangle. What is not flat is no
    // farther from the plane anywhere than at a corner.
    double error = std::max(std::abs(d_min), std::abs(d_max)) * 0x1p-36 + depth_error +
                   18.0 / kLeastHeight * position_error * (d_max - d_min) + std::abs(plane.d0) * 0x1p-48;
    for (int i = 0; i < c.count; ++i) error += std::abs(plane.d0 + plane.dx * c.x[i] + plane.dy * c.y[i] - c.d[i]);
    plane.error = static_cast<float>(error * (1.0 + 0x1p-20));
    return std::isfinite(plane.d0) && std::isfinite(plane.dx) && std::isfinite(plane.dy);
}

/// Columns of tiles that a polygon meets, per row of tiles from the first on; none: first > last.
struct RowSpans {
    static constexpr int kRows = 8;
    alignas(64) int32_t first[kRows], last[kRows];
    alignas(64) int32_t whole_first[kRows], whole_last[kRows];  ///< those that lie wholly inside it
};

/// The sides of a polygon as lines, and between which y it lies.
struct PolygonSides {
    Line line[Corners::kMax];
    int count;
    double y_least, y_most;
};

/// @param turn  which way the polygon winds, if it is surely convex; else 0
HWY_INLINE void spansOfRows(const Patch& patch, const PolygonSides& sides, int turn, int32_t row, RowSpans& out) {
    const D8 d;
    const I8 i32;
    const double e = patch.reach, left = 8.0 * patch.column0, bottom = 8.0 * (patch.row0 + row);
    const auto far = hn::Set(d, 1e30), zero = hn::Zero(d), eight = hn::Set(d, 8.0);
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto from = hn::Add(hn::Mul(hn::Iota(d, static_cast<double>(k)), eight), hn::Set(d, bottom - e));
        const auto to = hn::Add(from, hn::Set(d, 8.0 + 2.0 * e));
        auto low = far, high = hn::Neg(far), in_low = high, in_high = far;
        for (int i = 0; i < sides.count; ++i) {
            const Line& line = sides.line[i];
            const auto y = hn::Set(d, line.y), height = hn::Set(d, line.height), error = hn::Set(d, line.error());
            const auto ya = hn::Sub(from, y), yb = hn::Sub(to, y);
            const auto met = hn::And(hn::Le(ya, height), hn::Ge(yb, zero));
            auto xa = hn::Set(d, line.x_least), xb = hn::Set(d, line.x_most);
            if (!line.level) {
                const auto slope = hn::Set(d, line.slope), x = hn::Set(d, line.x);
                const auto pa = hn::Add(x, hn::Mul(hn::Min(hn::Max(ya, zero), height), slope));
                const auto pb = hn::Add(x, hn::Mul(hn::Min(hn::Max(yb, zero), height), slope));
                xa = hn::Min(pa, pb);
                xb = hn::Max(pa, pb);
            }
            low = hn::IfThenElse(met, hn::Min(low, hn::Sub(xa, error)), low);
            high = hn::IfThenElse(met, hn::Max(high, hn::Add(xb, error)), high);
            // Inside is on the left of a side that runs the polygon's way: the right of one that runs down.
            const bool on_left = line.down == (turn > 0);
            if (on_left) in_low = hn::IfThenElse(met, hn::Max(in_low, hn::Add(xb, error)), in_low);
            else in_high = hn::IfThenElse(met, hn::Min(in_high, hn::Sub(xa, error)), in_high);
        }
        const auto eighth = hn::Set(d, 0.125), one = hn::Set(d, 1.0);
        const auto column = [&](auto x, double by)
                                HWY_ATTR { return hn::Mul(hn::Add(x, hn::Set(d, by - left)), eighth); };
        const auto columns = hn::Set(d, static_cast<double>(patch.columns));
        const auto store = [&](auto v, int32_t* at) HWY_ATTR {
            // Truncation is the floor where it is not negative.
            hn::Store(hn::DemoteTo(i32, hn::Min(hn::Max(v, zero), columns)), i32, at + k);
        };
        store(column(low, -e), out.first);
        store(hn::Add(column(high, e), one), out.last);
        const auto tall =
            hn::And(hn::Gt(from, hn::Set(d, sides.y_least + e)), hn::Lt(to, hn::Set(d, sides.y_most - e)));
        store(hn::IfThenElse(tall, hn::Ceil(column(in_low, e)), columns), out.whole_first);
        store(hn::IfThenElse(tall, column(in_high, -e), zero), out.whole_last);
    }
    for (int k = 0; k < RowSpans::kRows; ++k) {
        --out.last[k];
        if (turn == 0) out.whole_last[k] = 0;
        --out.whole_last[k];
    }
}

/// Names a plane as one of those that the polygons in sixteen tiles lie on.
/// @param fresh   no polygon was there before
/// @param wanted  the tiles that the polygon meets
template <class U>
HWY_INLINE void namePlane(U u, uint32_t index, hn::Mask<U> fresh, hn::Mask<U> wanted, uint32_t* first,
                          uint32_t* second) {
    const auto none = hn::Set(u, DepthTiles::kNone), name = hn::Set(u, index);
    const auto one = hn::LoadU(u, first), two = hn::LoadU(u, second);
    const auto known = hn::Or(hn::Eq(one, none), hn::Or(hn::Eq(one, name), hn::Eq(two, name)));
    const auto room = hn::Eq(two, none);  // else there are too many
    const auto new_one = hn::IfThenElse(fresh, name, hn::IfThenElse(hn::Or(known, room), one, none));
    const auto new_two = hn::IfThenElse(fresh, none, hn::IfThenElse(known, two, hn::IfThenElse(room, name, none)));
    hn::BlendedStore(new_one, wanted, u, first);
    hn::BlendedStore(new_two, wanted, u, second);
}

/// Takes a polygon's part in a row of tiles: those that lie wholly inside it are covered by it alone; in the scratch the
/// others' depth is lowered to its own.
HWY_INLINE void lowerRow(Patch& patch, const BufferPlane& plane, uint32_t index, int32_t row, int32_t first,
                         int32_t last, int32_t whole_first, int32_t whole_last) {
    DepthTiles& tiles = patch.tiles;
    DepthTiles::Scratch& scratch = tiles.scratch;
    const F16 d;
    const hn::Rebind<uint32_t, F16> u;
    const double tilt = std::abs(plane.dx) + std::abs(plane.dy);
    const double center =
        plane.d0 + plane.dx * (8.0 * (patch.column0 + first) + 4.0) + plane.dy * (8.0 * (patch.row0 + row) + 4.0);
    const double error = plane.error + 0x1p-20 * (std::abs(center) + 8.0 * tilt * (last - first + 1));
    const auto start = hn::Set(d, static_cast<float>(center - 4.0 * tilt - error));
    const auto step = hn::Set(d, static_cast<float>(8.0 * plane.dx)), floor = hn::Set(d, plane.floor);
    const auto untouched = hn::Set(d, std::numeric_limits<float>::infinity());
    const size_t at = size_t{patch.pitch} * static_cast<size_t>(row) + static_cast<size_t>(first);
    const size_t tile =
        size_t{static_cast<uint32_t>(patch.row0 + row)} * tiles.stride + static_cast<size_t>(patch.column0 + first);
    const int32_t count = last - first + 1;
    const int32_t lanes = static_cast<int32_t>(hn::Lanes(d));
    for (int32_t i = 0; i < count; i += lanes) {
        float* z = scratch.z.data() + at + i;
        const auto depth = hn::Max(hn::Add(start, hn::Mul(step, hn::Iota(d, static_cast<float>(i)))), floor);
        const auto wanted = hn::FirstN(d, static_cast<size_t>(count - i));
        const auto old = hn::LoadU(d, z);
        namePlane(u, index, hn::RebindMask(u, hn::Eq(old, untouched)), hn::RebindMask(u, wanted),
                  scratch.plane.data() + at + i, scratch.second_plane.data() + at + i);
        hn::BlendedStore(hn::Min(old, depth), wanted, d, z);
        const int32_t from = std::max(whole_first - first - i, 0), end = std::min(whole_last + 1 - first - i, lanes);
        if (from >= end) continue;
        float* base = tiles.base.data() + tile + i;
        const auto whole =
            hn::AndNot(hn::FirstN(d, static_cast<size_t>(from)), hn::FirstN(d, static_cast<size_t>(end)));
        const auto better = hn::And(whole, hn::Gt(depth, hn::LoadU(d, base)));
        if (hn::AllFalse(d, better)) continue;
        hn::BlendedStore(depth, better, d, base);
        hn::BlendedStore(hn::Set(u, index), hn::RebindMask(u, better), u, tiles.plane.data() + tile + i);
        float* layer = tiles.layer.data() + tile + i;
        hn::BlendedStore(hn::Set(d, DepthTiles::kOpen), hn::And(better, hn::Le(hn::LoadU(d, layer), depth)), d, layer);
    }
}

/// Whether all corners surely turn the same way.
HWY_INLINE bool isConvex(const Corners& c, int turn, double reach) {
    for (int i = 0; i < c.count; ++i) {
        const int j = i + 1 < c.count ? i + 1 : 0, k = j + 1 < c.count ? j + 1 : 0;
        const double ux = c.x[j] - c.x[i], uy = c.y[j] - c.y[i], vx = c.x[k] - c.x[i], vy = c.y[k] - c.y[i];
        const double least = 4.0 * (reach + 0x1p-16) * (std::abs(ux) + std::abs(uy) + std::abs(vx) + std::abs(vy));
        if (!(turn * (ux * vy - vx * uy) > least)) return false;
    }
    return true;
}

/// Lowers the depth of the tiles that a polygon meets to its own.
/// @param turn  which way it winds
inline void addDepth(Patch& patch, const Corners& c, int turn) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    double x0 = c.x[0], x1 = x0, y0 = c.y[0], y1 = y0, d0 = c.d[0], d1 = d0;
    for (int i = 1; i < c.count; ++i) {
        x0 = std::min(x0, c.x[i]);
        x1 = std::max(x1, c.x[i]);
        y0 = std::min(y0, c.y[i]);
        y1 = std::max(y1, c.y[i]);
        d0 = std::min(d0, c.d[i]);
        d1 = std::max(d1, c.d[i]);
    }
    const double e = patch.reach;
    const double left = 8.0 * patch.column0, bottom = 8.0 * patch.row0;
    const double width = 8.0 * patch.columns, height = 8.0 * patch.rows;
    if (!(x1 + e >= left && y1 + e >= bottom && x0 - e < left + width && y0 - e < bottom + height)) return;
    const int32_t c0 = static_cast<int32_t>(std::max(x0 - e - left, 0.0)) >> 3;
    const int32_t c1 = static_cast<int32_t>(std::min(x1 + e - left, width - 1.0)) >> 3;
    const int32_t r0 = static_cast<int32_t>(std::max(y0 - e - bottom, 0.0)) >> 3;
    const int32_t r1 = static_cast<int32_t>(std::min(y1 + e - bottom, height - 1.0)) >> 3;
    const double corner_error = std::max(std::abs(d0), std::abs(d1)) * 0x1p-36 + patch.depth_error;
    const float farthest = static_cast<float>(d0 - corner_error - std::abs(d0) * 0x1p-22);
    BufferPlane plane;
    const bool small = c1 - c0 <= 1 && r1 - r0 <= 1 && d1 - d0 <= 0.01 * std::abs(d0);
    if (small || !planeOf(c, patch.depth_error, patch.position_error, plane)) {
        for (int32_t row = r0; row <= r1; ++row)
            for (int32_t column = c0; column <= c1; ++column) {
                const size_t at = size_t{patch.pitch} * static_cast<size_t>(row) + static_cast<size_t>(column);
                scratch.z[at] = std::min(scratch.z[at], farthest);
                scratch.plane[at] = scratch.second_plane[at] = DepthTiles::kNone;
            }
        return;
    }
    Array<BufferPlane>& planes = patch.tiles.planes;
    uint32_t index =
        findPlane(patch.tiles, c.x, c.y, c.d, c.count, static_cast<double>(plane.error), patch.first_plane, 8);
    if (index == DepthTiles::kNone) {
        plane.floor = farthest;
        plane.error += static_cast<float>(kFlatEnough * std::max(std::abs(d0), std::abs(d1)));
        index = static_cast<uint32_t>(planes.size());
        planes.push_back(plane);
    } else {
        planes[index].floor = std::min(planes[index].floor, farthest);
        plane = planes[index];
        plane.floor = farthest;
    }
    const bool large = c1 - c0 > 1 && r1 - r0 > 1;
    const int surely = large && isConvex(c, turn, patch.reach) ? turn : 0;
    PolygonSides sides;
    sides.count = c.count;
    sides.y_least = y0;
    sides.y_most = y1;
    for (int i = 0; i < c.count; ++i) {
        const int j = i + 1 < c.count ? i + 1 : 0;
        sides.line[i] = Line(c.x[i], c.y[i], c.x[j], c.y[j]);
    }
    RowSpans spans;
    for (int32_t row = r0; row <= r1; ++row) {
        const int k = (row - r0) % RowSpans::kRows;
        if (k == 0) spansOfRows(patch, sides, surely, row, spans);
        const int32_t first = std::max(spans.first[k], patch.tiles.scratch.first[static_cast<size_t>(row)]);
        const int32_t last = std::min(spans.last[k], patch.tiles.scratch.last[static_cast<size_t>(row)]);
        if (first <= last) lowerRow(patch, plane, index, row, first, last, spans.whole_first[k], spans.whole_last[k]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
