// A patch: polygons of one winding that are covered together; its outline, its depth per tile, and how both become claims.
// SPDX-License-Identifier: MIT
//
// The argument. Let F be a set of polygons, w(p) the number of those with counter-clockwise images that hold the image
// point p less the clockwise ones. Crossing an edge changes w unless another polygon of F has the same edge the other way
// round: all but the open edges cancel. So w is the same all over a pixel that no open edge touches; and if it is 1 or
// more at its centre, each ray through the pixel meets a front face of F, no farther than the farthest point of F there.
// w is a sum over the open edges that cross the row to the left of the centre. Rounding moves a vertex for all edges that
// meet there at once; w at a point changes only where an open edge passes over it, and the pixels within reach of
// that count as touched. So neither which way a sliver winds nor a rounded position can cover too much.
#if defined(SIGHTLINE_RASTER_PATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RASTER_PATCH_INL_H
#undef SIGHTLINE_RASTER_PATCH_INL_H
#else
#define SIGHTLINE_RASTER_PATCH_INL_H
#endif

#include <bit>

#include "sightline/raster/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

using D8 = hn::CappedTag<double, 8>;
using I8 = hn::Rebind<int32_t, D8>;

/// Where the image of something lies.
struct Extent {
    double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;  ///< [pixels]
    double nearest = -1e300;

    void grow(double x, double y, double d) {
        x0 = std::min(x0, x);
        x1 = std::max(x1, x);
        y0 = std::min(y0, y);
        y1 = std::max(y1, y);
        nearest = std::max(nearest, d);
    }
};

/// The tiles that a patch may meet, and what is known about it there; see DepthTiles::Scratch.
struct Patch {
    DepthTiles& tiles;
    double reach;           ///< bound on the error of positions and of what is computed from them  [pixels]
    double position_error;  ///< of corners alone [pixels]
    double depth_error;     ///< bound on the error of a corner's nearness
    float nearest = 0;      ///< no point of it is nearer
    int32_t column0 = 0, row0 = 0, columns = 0, rows = 0;  ///< [tiles]
    uint32_t pitch = 0;  ///< tiles from one row of the scratch to the next, a multiple of 16
    uint32_t words = 0;  ///< of marks in a row
    uint32_t slots = 0;  ///< in use
};

/// Lays out the scratch for the tiles that the extent meets; false if it misses the buffer.
inline bool beginPatch(Patch& patch, const Extent& extent) {
    DepthTiles& tiles = patch.tiles;
    const double e = patch.reach;
    if (!(extent.x1 + e >= 0 && extent.y1 + e >= 0 && extent.x0 - e < tiles.width && extent.y0 - e < tiles.height))
        return false;
    const auto tileOf = [](double at, double size) {
        return static_cast<int32_t>(std::clamp(at, 0.0, size - 1.0)) >> 3;
    };
    patch.column0 = tileOf(extent.x0 - e, tiles.width);
    patch.row0 = tileOf(extent.y0 - e, tiles.height);
    patch.columns = tileOf(extent.x1 + e, tiles.width) - patch.column0 + 1;
    patch.rows = tileOf(extent.y1 + e, tiles.height) - patch.row0 + 1;
    patch.pitch = static_cast<uint32_t>(patch.columns + 15) / 16 * 16;
    patch.words = static_cast<uint32_t>(patch.columns + 63) / 64;
    patch.slots = 0;
    const double near = extent.nearest + std::abs(extent.nearest) * 0x1p-22 + patch.depth_error;
    patch.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    DepthTiles::Scratch& scratch = tiles.scratch;
    const size_t count = size_t{patch.pitch} * static_cast<size_t>(patch.rows);
    if (scratch.z.size() < count) {
        scratch.z.resize(count);
        scratch.plane.resize(count);
        scratch.slot.resize(count);
    }
    const size_t marks = size_t{patch.words} * static_cast<size_t>(patch.rows);
    if (scratch.marked.size() < marks) scratch.marked.resize(marks);
    std::fill_n(scratch.z.data(), count, std::numeric_limits<float>::infinity());
    std::fill_n(scratch.marked.data(), marks, uint64_t{0});
    return true;
}

/// The slot of a tile that an open edge meets.
HWY_INLINE uint32_t slotOf(Patch& patch, uint32_t column, uint32_t row) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    uint64_t& word = scratch.marked[row * patch.words + column / 64];
    const uint64_t bit = uint64_t{1} << (column & 63);
    uint32_t& slot = scratch.slot[row * patch.pitch + column];
    if (word & bit) return slot;
    word |= bit;
    slot = patch.slots++;
    if (scratch.touched.size() < patch.slots) {
        scratch.touched.resize(2 * size_t{patch.slots});
        scratch.winding.resize(128 * size_t{patch.slots});
    }
    scratch.touched[slot] = 0;
    const hn::CappedTag<uint8_t, 64> d;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        hn::StoreU(hn::Zero(d), d, scratch.winding.data() + 64 * size_t{slot} + i);
    return slot;
}

/// A straight line from one point up to another, or along a row.
struct Line {
    double x, y, height, slope;  ///< slope 0 if it is level
    double x_least, x_most;
    bool level;

    HWY_INLINE Line(double ax, double ay, double bx, double by) {
        const bool up = ay <= by;
        x = up ? ax : bx;
        y = up ? ay : by;
        height = up ? by - ay : ay - by;
        x_least = std::min(ax, bx);
        x_most = std::max(ax, bx);
        level = height < 0x1p-10;
        slope = level ? 0.0 : ((up ? bx - ax : ax - bx) / height);
    }
    HWY_INLINE double at(double above) const { return x + above * slope; }
    /// Bound on the rounding of at(): a few steps of the coordinates, and of heights times the slope.
    HWY_INLINE double error() const {
        return (std::abs(x) + (x_most - x_least)) * 0x1p-48 +
               std::abs(slope) * (std::abs(y) + height + 8192.0) * 0x1p-50;
    }
};

/// Notes an open edge: the pixels that it touches, and where it changes the winding number.
/// @param up  the change where it runs upward; the opposite where it runs downward
inline void addOpenEdge(Patch& patch, double ax, double ay, double bx, double by, int change) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    const Line line(ax, ay, bx, by);
    const double e = patch.reach, left = 8.0 * patch.column0, bottom = 8.0 * patch.row0;
    const double ex = e + line.error();
    const double width = 8.0 * patch.columns, y0 = line.y - bottom, y1 = y0 + line.height;
    if (!(line.x_least - ex < left + width)) return;  // beyond the right border nothing counts
    const int32_t last_row = patch.rows - 1;
    const int32_t first = static_cast<int32_t>(std::clamp((y0 - e) * 0.125, 0.0, last_row + 1.0));
    const int32_t last = static_cast<int32_t>(std::clamp((y1 + e) * 0.125, -1.0, double(last_row)) + 1.0) - 1;
    const bool upward = ay <= by;
    const double top = upward ? by : ay;
    const uint8_t sign = ((change > 0) == upward) ? 0xff : 0x01;  // the inside is on the left of the edge
    const D8 d;
    const I8 i32;
    const hn::Rebind<uint8_t, D8> u8;
    const auto slope = hn::Set(d, line.slope), base = hn::Set(d, line.x - left), zero = hn::Zero(d);
    const auto height = hn::Set(d, line.height), grow = hn::Set(d, ex), right = hn::Set(d, width);
    const auto last_pixel = hn::Set(d, width - 1.0);
    for (int32_t row = first; row <= last; ++row) {
        // The tiles that the edge meets in this row.
        double xa, xb;
        if (line.level) {
            xa = line.x_least;
            xb = line.x_most;
        } else {
            xa = line.at(std::clamp(8.0 * row - e - y0, 0.0, line.height));
            xb = line.at(std::clamp(8.0 * row + 8.0 + e - y0, 0.0, line.height));
        }
        const double x_low = std::min(xa, xb) - ex - left, x_high = std::max(xa, xb) + ex - left;
        const int32_t t0 = static_cast<int32_t>(std::clamp(x_low * 0.125, 0.0, double(patch.columns)));
        const int32_t t1 = static_cast<int32_t>(std::clamp(x_high * 0.125, 0.0, patch.columns - 1.0));
        alignas(64) int32_t lows[8], highs[8], crossings[8];
        for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
            const auto y = hn::Iota(d, 8.0 * row + static_cast<double>(k) - y0);  // of the pixels' lower sides
            const auto from = hn::Sub(y, hn::Set(d, e)), to = hn::Add(y, hn::Set(d, 1.0 + e));
            const auto touched = hn::And(hn::Le(from, height), hn::Ge(to, zero));
            const auto pa = hn::Add(base, hn::Mul(hn::Min(hn::Max(from, zero), height), slope));
            const auto pb = hn::Add(base, hn::Mul(hn::Min(hn::Max(to, zero), height), slope));
            auto low = hn::Sub(hn::Min(pa, pb), grow), high = hn::Add(hn::Max(pa, pb), grow);
            if (line.level) {
                low = hn::Set(d, line.x_least - ex - left);
                high = hn::Set(d, line.x_most + ex - left);
            }
            const auto within = hn::And(touched, hn::And(hn::Ge(high, zero), hn::Lt(low, right)));
            low = hn::Max(low, zero);
            high = hn::Min(high, last_pixel);
            const auto none = hn::Set(d, 1e6);
            hn::Store(hn::DemoteTo(i32, hn::IfThenElse(within, low, none)), i32, lows + k);
            hn::Store(hn::DemoteTo(i32, hn::IfThenElse(within, high, hn::Neg(none))), i32, highs + k);
            const auto center = hn::Add(y, hn::Set(d, 0.5));
            const auto crossing = hn::Max(hn::Add(base, hn::Mul(center, slope)), zero);
            // Exact, so that where one edge ends the next begins.
            const auto row_y = hn::Iota(d, bottom + 8.0 * row + static_cast<double>(k) + 0.5);
            const auto crosses = hn::And(hn::And(hn::Ge(row_y, hn::Set(d, line.y)), hn::Lt(row_y, hn::Set(d, top))),
                                         hn::Lt(crossing, right));
            hn::Store(hn::DemoteTo(i32, hn::IfThenElse(crosses, crossing, none)), i32, crossings + k);
        }
        for (int32_t t = std::min(t0, t1); t <= t1; ++t) {
            const uint32_t slot = slotOf(patch, static_cast<uint32_t>(t), static_cast<uint32_t>(row));
            uint8_t* touched = reinterpret_cast<uint8_t*>(scratch.touched.data() + slot);
            uint8_t* winding = scratch.winding.data() + 64 * size_t{slot};
            for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
                const auto eight = hn::Set(i32, 8), none = hn::Zero(i32), ones = hn::Set(i32, 0xff);
                const auto low = hn::Sub(hn::Load(i32, lows + k), hn::Set(i32, 8 * t));
                const auto high = hn::Sub(hn::Set(i32, 8 * t + 7), hn::Load(i32, highs + k));
                const auto bits = hn::And(hn::And(hn::Shl(ones, hn::Min(hn::Max(low, none), eight)),
                                                  hn::Shr(ones, hn::Min(hn::Max(high, none), eight))),
                                          ones);
                const auto byte = hn::TruncateTo(u8, hn::BitCast(hn::Rebind<uint32_t, I8>(), bits));
                hn::StoreU(hn::Or(hn::LoadU(u8, touched + k), byte), u8, touched + k);
                const auto at = hn::Sub(hn::Load(i32, crossings + k), hn::Set(i32, 8 * t));
                uint64_t here = bitsFromMask(i32, hn::And(hn::Gt(at, hn::Set(i32, -1)), hn::Lt(at, eight)));
                for (; here; here &= here - 1) {
                    const size_t row_of_tile = k + static_cast<size_t>(std::countr_zero(here));
                    uint8_t& place = winding[8 * row_of_tile + static_cast<size_t>(crossings[row_of_tile] & 7)];
                    place = static_cast<uint8_t>(place + sign);
                }
            }
        }
    }
}

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
};

HWY_INLINE void spansOfRows(const Patch& patch, const Corners& c, int32_t row, RowSpans& out) {
    const D8 d;
    const I8 i32;
    const double e = patch.reach, left = 8.0 * patch.column0;
    const auto far = hn::Set(d, 1e30);
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto from =
            hn::Add(hn::Mul(hn::Iota(d, patch.row0 + row + static_cast<double>(k)), hn::Set(d, 8.0)), hn::Set(d, -e));
        const auto to = hn::Add(from, hn::Set(d, 8.0 + 2.0 * e));
        auto low = far, high = hn::Neg(far);
        for (int i = 0; i < c.count; ++i) {
            const int j = i + 1 < c.count ? i + 1 : 0;
            const Line line(c.x[i], c.y[i], c.x[j], c.y[j]);
            const auto y = hn::Set(d, line.y), height = hn::Set(d, line.height), zero = hn::Zero(d);
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
            const auto error = hn::Set(d, line.error());
            low = hn::IfThenElse(met, hn::Min(low, hn::Sub(xa, error)), low);
            high = hn::IfThenElse(met, hn::Max(high, hn::Add(xb, error)), high);
        }
        const auto eighth = hn::Set(d, 0.125), grow = hn::Set(d, e);
        const auto a = hn::Mul(hn::Sub(hn::Sub(low, grow), hn::Set(d, left)), eighth);
        const auto b = hn::Mul(hn::Sub(hn::Add(high, grow), hn::Set(d, left)), eighth);
        // Truncation is the floor where it is not negative.
        const auto columns = hn::Set(d, static_cast<double>(patch.columns));
        hn::Store(hn::DemoteTo(i32, hn::Min(hn::Max(a, hn::Zero(d)), columns)), i32, out.first + k);
        const auto b1 = hn::Min(hn::Max(hn::Add(b, hn::Set(d, 1.0)), hn::Zero(d)), columns);
        hn::Store(hn::Sub(hn::DemoteTo(i32, b1), hn::Set(i32, 1)), i32, out.last + k);
    }
}

/// Lowers the depth of tiles in a row of the scratch to a plane's.
HWY_INLINE void lowerRow(Patch& patch, const BufferPlane& plane, uint32_t index, int32_t row, int32_t first,
                         int32_t last) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
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
    const size_t count = static_cast<size_t>(last - first + 1);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        float* z = scratch.z.data() + at + i;
        uint32_t* planes = scratch.plane.data() + at + i;
        const auto depth = hn::Max(hn::Add(start, hn::Mul(step, hn::Iota(d, static_cast<float>(i)))), floor);
        const auto wanted = hn::FirstN(d, count - i);
        const auto old = hn::LoadU(d, z);
        const auto index_or_none =
            hn::IfThenElse(hn::RebindMask(u, hn::Eq(old, untouched)), hn::Set(u, index), hn::Set(u, DepthTiles::kNone));
        hn::BlendedStore(index_or_none, hn::RebindMask(u, wanted), u, planes);
        hn::BlendedStore(hn::Min(old, depth), wanted, d, z);
    }
}

/// Lowers the depth of the tiles that a polygon meets to its own.
inline void addDepth(Patch& patch, const Corners& c) {
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
                scratch.plane[at] = DepthTiles::kNone;
            }
        return;
    }
    plane.floor = farthest;
    const uint32_t index = static_cast<uint32_t>(patch.tiles.planes.size());
    patch.tiles.planes.push_back(plane);
    RowSpans spans;
    for (int32_t row = r0; row <= r1; ++row) {
        const int k = (row - r0) % RowSpans::kRows;
        if (k == 0) spansOfRows(patch, c, row, spans);
        const int32_t first = std::max(spans.first[k], c0), last = std::min(spans.last[k], c1);
        if (first <= last) lowerRow(patch, plane, index, row, first, last);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
