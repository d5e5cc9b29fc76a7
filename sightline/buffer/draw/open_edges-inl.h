// The open edges of a patch: which pixels each touches, and where it changes the winding number.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_OPEN_EDGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_OPEN_EDGES_INL_H
#undef SIGHTLINE_BUFFER_DRAW_OPEN_EDGES_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_OPEN_EDGES_INL_H
#endif

#include "sightline/buffer/draw/patch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

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

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
