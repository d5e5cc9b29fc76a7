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
    uint32_t slots = 0;  ///< in use
    /// What lies beside these rows and columns does not matter; on their left, only where the winding number changes.
    int32_t open_low = 0, open_high = 0, open_first = 0, open_last = 0;  ///< [tiles]
};

/// Finds the columns of a row of tiles between which something so near may lie in front of what they claim.
/// @param base   of the first tile
/// @param last  -1 if there are none
HWY_INLINE void openInRow(const float* base, int32_t columns, float nearest, int32_t& first, int32_t& last) {
    const F16 d;
    first = columns;
    last = -1;
    for (int32_t i = 0; i < columns; i += static_cast<int32_t>(hn::Lanes(d))) {
        const auto within = hn::FirstN(d, static_cast<size_t>(columns - i));
        const auto open = hn::And(within, hn::Lt(hn::LoadU(d, base + i), hn::Set(d, nearest)));
        const uint64_t bits = bitsFromMask(d, open);
        if (!bits) continue;
        if (last < 0) first = i + std::countr_zero(bits);
        last = i + 63 - std::countl_zero(bits);
    }
}

/// Finds in each row the columns between which the patch may lie in front of what the tiles claim; false if nowhere.
HWY_INLINE bool openColumns(Patch& patch) {
    DepthTiles& tiles = patch.tiles;
    patch.open_low = patch.rows;
    patch.open_high = patch.open_last = -1;
    patch.open_first = patch.columns;
    for (int32_t row = 0; row < patch.rows; ++row) {
        const float* base = tiles.base.data() + size_t{static_cast<uint32_t>(patch.row0 + row)} * tiles.stride +
                            static_cast<size_t>(patch.column0);
        int32_t &first = tiles.scratch.first[static_cast<size_t>(row)],
                &last = tiles.scratch.last[static_cast<size_t>(row)];
        openInRow(base, patch.columns, patch.nearest, first, last);
        if (last < 0) continue;
        patch.open_low = std::min(patch.open_low, row);
        patch.open_high = row;
        patch.open_first = std::min(patch.open_first, first);
        patch.open_last = std::max(patch.open_last, last);
    }
    return patch.open_high >= 0;
}

/// Lays out the scratch for the tiles that matter and that the extent meets; false if there are none.
inline bool beginPatch(Patch& patch, const Extent& extent) {
    DepthTiles& tiles = patch.tiles;
    const double e = patch.reach;
    const double left = 8.0 * tiles.first_column, right = 8.0 * tiles.end_column;
    if (!(extent.x1 + e >= left && extent.y1 + e >= 0 && extent.x0 - e < right && extent.y0 - e < tiles.height))
        return false;
    const auto tileOf = [](double at, double low, double high) {
        return static_cast<int32_t>(std::clamp(at, low, high - 1.0)) >> 3;
    };
    patch.column0 = tileOf(extent.x0 - e, left, right);
    patch.row0 = tileOf(extent.y0 - e, 0, tiles.height);
    patch.columns = tileOf(extent.x1 + e, left, right) - patch.column0 + 1;
    patch.rows = tileOf(extent.y1 + e, 0, tiles.height) - patch.row0 + 1;
    patch.pitch = static_cast<uint32_t>(patch.columns + 15) / 16 * 16;
    patch.slots = 0;
    const double near = extent.nearest + std::abs(extent.nearest) * 0x1p-22 + patch.depth_error;
    patch.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    DepthTiles::Scratch& scratch = tiles.scratch;
    const size_t count = size_t{patch.pitch} * static_cast<size_t>(patch.rows);
    if (scratch.slot.size() < count + DepthTiles::kBeyond) {
        scratch.z.resize(count + DepthTiles::kBeyond);
        scratch.plane.resize(count + DepthTiles::kBeyond);
        scratch.slot.resize(count + DepthTiles::kBeyond);
    }
    if (scratch.first.size() < static_cast<size_t>(patch.rows)) {
        scratch.first.resize(static_cast<size_t>(patch.rows));
        scratch.last.resize(static_cast<size_t>(patch.rows));
    }
    if (!openColumns(patch)) return false;
    std::fill_n(scratch.z.data(), count, std::numeric_limits<float>::infinity());
    std::fill_n(scratch.plane.data(), count, DepthTiles::kNone);
    std::fill_n(scratch.slot.data(), count, DepthTiles::kNone);
    return true;
}

/// Makes room for more tiles that open edges meet.
HWY_INLINE void reserveSlots(Patch& patch, uint32_t more) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    if (scratch.touched.size() >= patch.slots + more) return;
    scratch.touched.resize(2 * size_t{patch.slots + more});
    scratch.winding.resize(128 * size_t{patch.slots + more});
}

/// The slot of a tile that an open edge meets; there must be room.
/// @param at  its place in the scratch
HWY_INLINE uint32_t slotOf(Patch& patch, size_t at) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    uint32_t& slot = scratch.slot[at];
    if (slot != DepthTiles::kNone) return slot;
    slot = patch.slots++;
    scratch.touched[slot] = 0;
    const hn::CappedTag<uint8_t, 64> d;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        hn::StoreU(hn::Zero(d), d, scratch.winding.data() + 64 * size_t{slot} + i);
    return slot;
}

constexpr double kLevel = 0x1p-10;  // [pixels]: an edge that rises less counts as level

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

/// Open edges of a patch, as they are gathered.
struct OpenEdges {
    static constexpr int kMost = 1024;
    alignas(64) double ax[kMost + 8], ay[kMost + 8], bx[kMost + 8], by[kMost + 8];
    int8_t change[kMost];  ///< of the winding number where the edge runs upward; the opposite where it runs downward
    int count = 0;

    HWY_INLINE void add(double x0, double y0, double x1, double y1, int by_how_much) {
        ax[count] = x0;
        ay[count] = y0;
        bx[count] = x1;
        by[count] = y1;
        change[count++] = static_cast<int8_t>(by_how_much);
    }
};

/// What the rows of tiles need of some edges; places are relative to the patch's lower left corner.
struct EdgeSetups {
    static constexpr int kMost = 8;
    alignas(64) double x[kMost], slope[kMost];  ///< x at the centre of the lowest row of pixels; its change per row
    alignas(64) double x_least[kMost], x_most[kMost];          ///< of pixels that it may touch
    alignas(64) double reach[kMost];                           ///< bound on all errors, along x
    alignas(64) int32_t first[kMost], last[kMost];             ///< rows of pixels that it may touch
    alignas(64) int32_t cross_first[kMost], cross_end[kMost];  ///< rows whose centres it crosses
    alignas(64) int32_t upward[kMost];                         ///< 1: it runs upward
};

HWY_INLINE void setUpEdges(const Patch& patch, const OpenEdges& edges, int at, EdgeSetups& out) {
    const D8 d;
    const I8 i32;
    const double left = 8.0 * patch.column0, bottom = 8.0 * patch.row0, rows = 8.0 * patch.rows;
    const auto zero = hn::Zero(d), e = hn::Set(d, patch.reach), half = hn::Set(d, 0.5), top = hn::Set(d, rows);
    for (int k = 0; k < EdgeSetups::kMost; k += static_cast<int>(hn::Lanes(d))) {
        const auto ax = hn::Load(d, edges.ax + at + k), ay = hn::Load(d, edges.ay + at + k);
        const auto bx = hn::Load(d, edges.bx + at + k), by = hn::Load(d, edges.by + at + k);
        const auto up = hn::Le(ay, by);
        const auto y_low = hn::Min(ay, by), y_high = hn::Max(ay, by), height = hn::Sub(y_high, y_low);
        const auto x_low = hn::IfThenElse(up, ax, bx), x_high = hn::IfThenElse(up, bx, ax);
        // A level edge has no slope to rely on: it may be anywhere along its row.
        const auto level = hn::Lt(height, hn::Set(d, kLevel));
        const auto run = hn::Sub(x_high, x_low);
        const auto slope = hn::IfThenElse(level, zero, hn::Div(run, hn::IfThenElse(level, hn::Set(d, 1.0), height)));
        // A few steps of the coordinates, and of heights times the slope.
        const auto size = hn::Add(hn::Abs(x_low), hn::Abs(run));
        const auto tall = hn::Add(hn::Add(hn::Abs(y_low), height), hn::Set(d, 8192.0));
        const auto error =
            hn::Add(hn::Mul(size, hn::Set(d, 0x1p-48)), hn::Mul(hn::Mul(hn::Abs(slope), tall), hn::Set(d, 0x1p-50)));
        const auto reach = hn::IfThenElse(level, hn::Add(hn::Abs(run), hn::Add(e, error)), hn::Add(e, error));
        const auto y = hn::Sub(y_low, hn::Set(d, bottom));
        hn::Store(hn::Add(hn::Sub(x_low, hn::Set(d, left)), hn::Mul(hn::Sub(half, y), slope)), d, out.x + k);
        hn::Store(slope, d, out.slope + k);
        hn::Store(hn::Sub(hn::Sub(hn::Min(ax, bx), hn::Set(d, left)), hn::Add(e, error)), d, out.x_least + k);
        hn::Store(hn::Add(hn::Sub(hn::Max(ax, bx), hn::Set(d, left)), hn::Add(e, error)), d, out.x_most + k);
        hn::Store(reach, d, out.reach + k);
        const auto row = [&](auto v, double low, double high) HWY_ATTR {
            return hn::DemoteTo(i32, hn::Min(hn::Max(hn::Floor(v), hn::Set(d, low)), hn::Set(d, high)));
        };
        hn::Store(row(hn::Sub(y, e), 0.0, rows), i32, out.first + k);
        hn::Store(row(hn::Add(hn::Add(y, height), e), -1.0, rows - 1.0), i32, out.last + k);
        // The same function of y for all edges that end there, so that where one ends the next begins.
        const auto crossed = [&](auto v) HWY_ATTR {
            const auto first = hn::Sub(hn::Ceil(hn::Sub(v, half)), hn::Set(d, bottom));
            return hn::DemoteTo(i32, hn::Min(hn::Max(first, zero), top));
        };
        hn::Store(crossed(y_low), i32, out.cross_first + k);
        hn::Store(crossed(y_high), i32, out.cross_end + k);
        hn::Store(hn::DemoteTo(i32, hn::IfThenElseZero(up, hn::Set(d, 1.0))), i32, out.upward + k);
    }
}

/// Bytes of a word from the first to the last, inclusive; none if first > last. Both in -8 to 15.
HWY_INLINE uint64_t bytesBetween(int32_t first, int32_t last) {
    if (last < 0 || first > 7 || first > last) return 0;
    return ~uint64_t{0} << (8 * std::max(first, 0)) & ~uint64_t{0} >> (56 - 8 * std::min(last, 7));
}

/// Changes the winding number of a tile where an edge crosses its rows of pixels.
/// @param crossings  per row the pixel that it crosses; those outside the tile do not matter
/// @param x          the tile's first
HWY_INLINE void addCrossings(const int32_t* crossings, int32_t x, uint8_t change, uint8_t* winding) {
#if HWY_TARGET == HWY_SCALAR
    for (int32_t k = 0; k < 8; ++k)
        if (const int32_t at = crossings[k] - x; at >= 0 && at < 8)
            winding[8 * k + at] = static_cast<uint8_t>(winding[8 * k + at] + change);
#else
    const hn::CappedTag<uint64_t, 8> rows;
    const hn::Rebind<int32_t, decltype(rows)> i32;
    const hn::Rebind<int64_t, decltype(rows)> i64;
    const hn::CappedTag<uint8_t, 8 * hn::MaxLanes(rows)> bytes;
    for (size_t k = 0; k < 8; k += hn::Lanes(rows)) {
        const auto at = hn::PromoteTo(i64, hn::Sub(hn::LoadU(i32, crossings + k), hn::Set(i32, x)));
        const auto within = hn::And(hn::Gt(at, hn::Set(i64, -1)), hn::Lt(at, hn::Set(i64, 8)));
        const auto bits = hn::BitCast(rows, hn::And(hn::ShiftLeft<3>(at), hn::Set(i64, 63)));
        const auto word = hn::IfThenElseZero(hn::RebindMask(rows, within), hn::Shl(hn::Set(rows, change), bits));
        uint8_t* eight = winding + 8 * k;
        hn::StoreU(hn::Add(hn::LoadU(bytes, eight), hn::BitCast(bytes, word)), bytes, eight);
    }
#endif
}

/// Notes what an edge is to the tiles of one row: the pixels that it touches, and where the winding number changes.
HWY_INLINE void addEdgeInRow(Patch& patch, const EdgeSetups& s, int i, int32_t row, uint8_t change) {
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    const F8 d;
    const hn::Rebind<int32_t, F8> i32;
    const hn::Rebind<uint8_t, F8> u8;
    const int32_t width = 8 * patch.columns;
    const double start = s.x[i] + 8.0 * row * s.slope[i];
    const float slope = static_cast<float>(s.slope[i]), x = static_cast<float>(start);
    // Float adds its own: a few steps of what is computed here.
    const float reach = static_cast<float>(s.reach[i]) + 0x1p-20f * (std::abs(x) + 8.0f * std::abs(slope));
    const float half = std::abs(slope) * (0.5f + static_cast<float>(patch.reach)) + reach;
    const float edge = 0x1p-20f * static_cast<float>(width);
    const float least = static_cast<float>(std::max(s.x_least[i], -1.0)) - edge;
    const float most = static_cast<float>(std::min(s.x_most[i], width + 1.0)) + edge;
    const int32_t k0 = std::max(s.first[i] - 8 * row, 0), k1 = std::min(s.last[i] - 8 * row, 7);
    const float xa = x + slope * static_cast<float>(k0), xb = x + slope * static_cast<float>(k1);
    const float low_all = std::max(std::min(xa, xb) - half, least), high_all = std::min(std::max(xa, xb) + half, most);
    // What lies left of the columns that matter changes the winding number at their border; right of them nothing does.
    const int32_t first = scratch.first[static_cast<size_t>(row)], last = scratch.last[static_cast<size_t>(row)];
    if (!(low_all < static_cast<float>(8 * last + 8))) return;
    const int32_t c0 = std::max(s.cross_first[i] - 8 * row, 0), c1 = std::min(s.cross_end[i] - 8 * row, 8);
    if (high_all < static_cast<float>(8 * first)) {
        if (c0 >= c1) return;
        reserveSlots(patch, 1);
        const uint32_t slot =
            slotOf(patch, size_t{patch.pitch} * static_cast<size_t>(row) + static_cast<size_t>(first));
        for (int32_t k = c0; k < c1; ++k) {
            uint8_t& place = scratch.winding[64 * size_t{slot} + 8 * static_cast<size_t>(k)];
            place = static_cast<uint8_t>(place + change);
        }
        return;
    }
    const int32_t t0 = std::max(static_cast<int32_t>(std::max(low_all, 0.0f)) >> 3, first);
    const int32_t t1 = std::clamp(static_cast<int32_t>(std::max(high_all, 0.0f)) >> 3, first, last);
    const uint64_t rows_touched = bytesBetween(k0, k1);
    alignas(32) int32_t lows[8], highs[8], crossings[8];
    const auto zero = hn::Zero(d), beyond = hn::Set(d, static_cast<float>(width));
    const auto border = hn::Set(d, static_cast<float>(8 * first));
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto at = hn::Add(hn::Set(d, x), hn::Mul(hn::Set(d, slope), hn::Iota(d, static_cast<float>(k))));
        const auto low = hn::Max(hn::Sub(at, hn::Set(d, half)), hn::Set(d, least));
        const auto high = hn::Min(hn::Add(at, hn::Set(d, half)), hn::Set(d, most));
        const auto crossing = hn::Min(hn::Max(at, hn::Set(d, least)), hn::Set(d, most));
        hn::Store(hn::ConvertTo(i32, hn::Min(hn::Max(low, zero), beyond)), i32, lows + k);
        // Truncation is the floor but between -1 and 0: there, one less.
        hn::Store(hn::Sub(hn::ConvertTo(i32, hn::Min(hn::Max(hn::Add(high, hn::Set(d, 1.0f)), zero), beyond)),
                          hn::Set(i32, 1)),
                  i32, highs + k);
        // Beyond all tiles in rows whose centres it does not cross.
        const auto row_of_pixels = hn::Iota(i32, static_cast<int32_t>(k));
        const auto crossed =
            hn::And(hn::Gt(row_of_pixels, hn::Set(i32, c0 - 1)), hn::Lt(row_of_pixels, hn::Set(i32, c1)));
        hn::Store(hn::IfThenElse(crossed, hn::ConvertTo(i32, hn::Min(hn::Max(crossing, border), beyond)),
                                 hn::Set(i32, 1 << 20)),
                  i32, crossings + k);
    }
    reserveSlots(patch, static_cast<uint32_t>(std::max(t1 - t0 + 1, 0)));
    for (int32_t t = t0; t <= t1; ++t) {
        const uint32_t slot = slotOf(patch, size_t{patch.pitch} * static_cast<size_t>(row) + static_cast<size_t>(t));
        alignas(8) uint8_t touched[8];
        for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
            const auto eight = hn::Set(i32, 8), none = hn::Zero(i32), ones = hn::Set(i32, 0xff);
            const auto low = hn::Sub(hn::Load(i32, lows + k), hn::Set(i32, 8 * t));
            const auto high = hn::Sub(hn::Set(i32, 8 * t + 7), hn::Load(i32, highs + k));
            const auto bits = hn::And(hn::And(hn::Shl(ones, hn::Min(hn::Max(low, none), eight)),
                                              hn::Shr(ones, hn::Min(hn::Max(high, none), eight))),
                                      ones);
            hn::StoreU(hn::DemoteTo(u8, bits), u8, touched + k);
        }
        uint64_t word;
        std::memcpy(&word, touched, sizeof word);
        scratch.touched[slot] |= word & rows_touched;
        if (c0 < c1) addCrossings(crossings, 8 * t, change, scratch.winding.data() + 64 * size_t{slot});
    }
}

/// Notes the open edges: the pixels that they touch, and where they change the winding number.
inline void addOpenEdges(Patch& patch, OpenEdges& edges) {
    EdgeSetups setups;
    for (int k = 0; k < EdgeSetups::kMost; ++k)  // read, but not used
        edges.ax[edges.count + k] = edges.ay[edges.count + k] = edges.bx[edges.count + k] = edges.by[edges.count + k] =
            0;
    for (int at = 0; at < edges.count; at += EdgeSetups::kMost) {
        setUpEdges(patch, edges, at, setups);
        for (int i = 0; i < std::min(EdgeSetups::kMost, edges.count - at); ++i) {
            if (setups.first[i] > setups.last[i] || !(setups.x_least[i] < 8.0 * patch.columns)) continue;
            const uint8_t change = (edges.change[at + i] > 0) == (setups.upward[i] == 1) ? 0xff : 0x01;
            for (int32_t row = setups.first[i] >> 3; row <= setups.last[i] >> 3; ++row)
                if (patch.tiles.scratch.last[static_cast<size_t>(row)] >= 0)
                    addEdgeInRow(patch, setups, i, row, change);
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
    alignas(64) int32_t whole_first[kRows], whole_last[kRows];  ///< those that lie wholly inside it
};

/// The sides of a polygon as lines, and between which y it lies.
struct Sides {
    Line line[Corners::kMax];
    int count;
    double y_least, y_most;
};

/// @param turn  which way the polygon winds, if it is surely convex; else 0
HWY_INLINE void spansOfRows(const Patch& patch, const Sides& sides, int turn, int32_t row, RowSpans& out) {
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
        const auto index_or_none =
            hn::IfThenElse(hn::RebindMask(u, hn::Eq(old, untouched)), hn::Set(u, index), hn::Set(u, DepthTiles::kNone));
        hn::BlendedStore(index_or_none, hn::RebindMask(u, wanted), u, scratch.plane.data() + at + i);
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
                scratch.plane[at] = DepthTiles::kNone;
            }
        return;
    }
    plane.floor = farthest;
    const uint32_t index = static_cast<uint32_t>(patch.tiles.planes.size());
    patch.tiles.planes.push_back(plane);
    const bool large = c1 - c0 > 1 && r1 - r0 > 1;
    const int surely = large && isConvex(c, turn, patch.reach) ? turn : 0;
    Sides sides;
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
