// A convex outline by its sides: the pixels of a row of tiles that lie inside all of them, and those that it may touch.
// SPDX-License-Identifier: MIT
//
// The argument. A pixel is covered if it lies on the inner hand of each side's line, farther from it than all errors. Let
// the sides be the boundary of a set of polygons, closed chains that is. Seen from a point of the pixel each of them turns
// the same way, so the winding number is 1 or more; and moving the corners within their errors moves no side over it. So
// it holds for chains around what is not convex, too.
#if defined(SIGHTLINE_BUFFER_DRAW_CONVEX_OUTLINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_CONVEX_OUTLINE_INL_H
#undef SIGHTLINE_BUFFER_DRAW_CONVEX_OUTLINE_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_CONVEX_OUTLINE_INL_H
#endif

#include "sightline/buffer/draw/cluster_draw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The spans of a row of tiles: per row of pixels the first one and the one after the last.
struct PixelSpans {
    alignas(32) int32_t first[8], end[8];
    int32_t column0, column1;   ///< tiles that they meet; none if column0 > column1
    int32_t whole0, whole_end;  ///< tiles of which they hold all, if any

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

/// PolygonSides that bound an outline from one hand, none of them level.
struct HandSides {
    static constexpr int kMost = 12;

    double x[kMost], slope[kMost];  ///< at the centre of the lowest row; change per row
    float wide[kMost];              ///< from there, along x, on either hand: what the side may touch
    int count = 0;

    HWY_INLINE void add(double at, double tilt, float reach) {
        x[count] = at;
        slope[count] = tilt;
        wide[count++] = reach;
    }
};

/// An outline by its sides, each of which has all of it on one hand; counted from the lower left corner of the tiles that it may
/// meet.
struct ConvexOutline {
    HandSides left, right;
    double inner_low, inner_high;          ///< y between which level sides leave something inside
    double low, high, x_least, x_most;     ///< bounds of the corners
    double reach;                          ///< bound on the error of a corner  [pixels]
    int32_t column0, row0, columns, rows;  ///< [tiles]

    inline bool place(const DepthTiles& tiles, double x0, double y0, double x1, double y1, double position_error);
    inline void addSide(double ax, double ay, double bx, double by, int turn);
    template <bool kOuter>
    inline void spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const;
};

/// Finds the tiles that it may meet, from the bounds of its corners; false if there are none.
inline bool ConvexOutline::place(const DepthTiles& tiles, double x0, double y0, double x1, double y1,
                                 double position_error) {
    const double far = std::max(std::max(std::abs(x0), std::abs(x1)), std::max(std::abs(y0), std::abs(y1)));
    const double e = position_error + kEvaluation + tiles.gap + far * 0x1p-48;
    reach = e;
    if (!(x1 + e >= 0 && y1 + e >= 0 && x0 - e < tiles.width && y0 - e < tiles.height)) return false;
    const auto tileOf = [](double at, double size) {
        return static_cast<int32_t>(std::clamp(at, 0.0, size - 1.0)) >> 3;
    };
    column0 = tileOf(x0 - e, tiles.width);
    row0 = tileOf(y0 - e, tiles.height);
    columns = tileOf(x1 + e, tiles.width) - column0 + 1;
    rows = tileOf(y1 + e, tiles.height) - row0 + 1;
    x_least = x0 - 8.0 * column0;
    x_most = x1 - 8.0 * column0;
    low = inner_low = y0 - 8.0 * row0;
    high = inner_high = y1 - 8.0 * row0;
    return true;
}

/// @param turn  1: what it bounds lies on its left, -1: on its right
inline void ConvexOutline::addSide(double ax, double ay, double bx, double by, int turn) {
    const Line line(ax, ay, bx, by);
    if (!line.level) {
        const double x = line.x + (0.5 - line.y) * line.slope;
        // Float adds its own: a few steps of what is computed at any row.
        const double tilt = std::abs(line.slope), all = std::abs(x) + 8.0 * (rows + 1) * tilt;
        const double error = line.error() + std::abs(line.x) * 0x1p-50;
        const float wide = static_cast<float>(tilt * (0.5 + reach) + reach + error + 0x1p-20 * (all + error));
        return (line.down == (turn > 0) ? left : right).add(x, line.slope, wide);
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
inline void ConvexOutline::spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const {
    const F8 d;
    const hn::Rebind<int32_t, F8> i32;
    const float width = static_cast<float>(8 * columns);
    const float edge = 0x1p-20f * width;
    const float first_x = static_cast<float>(std::max(x_least, -1.0)),
                last_x = static_cast<float>(std::min(x_most, width + 1.0));
    const float e = static_cast<float>(reach) * (1.0f + 0x1p-20f);
    const auto zero = hn::Zero(d), beyond = hn::Set(d, width), one = hn::Set(d, 1.0f);
    const auto far = hn::Set(i32, 1 << 20);
    auto least = far, most = hn::Neg(far), outer_least = far, outer_most = most, last_first = most, first_end = far;
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto rows_up = hn::Iota(d, static_cast<float>(k));
        auto low = hn::Set(d, first_x + e + edge), high = hn::Set(d, last_x - e - edge);
        auto outer_low = hn::Set(d, first_x - e - edge), outer_high = hn::Set(d, last_x + e + edge);
        const auto at = [&](const HandSides& hand, int i) HWY_ATTR {
            const float start = static_cast<float>(hand.x[i] + 8.0 * row * hand.slope[i]);
            return hn::Add(hn::Set(d, start), hn::Mul(hn::Set(d, static_cast<float>(hand.slope[i])), rows_up));
        };
        for (int i = 0; i < left.count; ++i) {
            const auto x = at(left, i), wide = hn::Set(d, left.wide[i]);
            low = hn::Max(low, hn::Add(x, wide));
            if (kOuter) outer_low = hn::Max(outer_low, hn::Sub(x, wide));
        }
        for (int i = 0; i < right.count; ++i) {
            const auto x = at(right, i), wide = hn::Set(d, right.wide[i]);
            high = hn::Min(high, hn::Sub(x, wide));
            if (kOuter) outer_high = hn::Min(outer_high, hn::Add(x, wide));
        }
        const auto whole = [&](auto v) HWY_ATTR { return hn::ConvertTo(i32, hn::Min(hn::Max(v, zero), beyond)); };
        const auto note = [&](PixelSpans& to, auto first, auto end, auto& lowest, auto& highest) HWY_ATTR {
            hn::Store(first, i32, to.first + k);
            hn::Store(end, i32, to.end + k);
            const auto some = hn::Lt(first, end);
            lowest = hn::Min(lowest, hn::IfThenElse(some, first, lowest));
            highest = hn::Max(highest, hn::IfThenElse(some, end, highest));
        };
        const auto first = whole(hn::Add(low, one)), end = whole(high);
        note(inner, first, end, least, most);
        if (!kOuter) continue;
        note(outer, whole(outer_low), whole(hn::Add(outer_high, one)), outer_least, outer_most);
        last_first = hn::Max(last_first, first);
        first_end = hn::Min(first_end, end);
    }
    const auto close = [&](PixelSpans& to, auto lowest, auto highest) HWY_ATTR {
        to.column0 = hn::GetLane(hn::MinOfLanes(i32, lowest)) >> 3;
        to.column1 = (hn::GetLane(hn::MaxOfLanes(i32, highest)) - 1) >> 3;
    };
    close(inner, least, most);
    if (!kOuter) return;
    close(outer, outer_least, outer_most);
    inner.whole0 = (hn::GetLane(hn::MaxOfLanes(i32, last_first)) + 7) >> 3;
    inner.whole_end = hn::GetLane(hn::MinOfLanes(i32, first_end)) >> 3;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
