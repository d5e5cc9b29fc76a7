// Which pixels of a row of blocks the edges of a cluster bound: winding numbers and touches, in bits.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_COVER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_COVER_INL_H
#undef SIGHTLINE_BUFFER_DRAW_COVER_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_COVER_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/buffer/draw/project-inl.h"
#include "sightline/buffer/draw/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
/// Brings edges into the form that rows read.
/// @param bounds  grows by what the edges touch: x0 y0 x1 y1
inline void setUpEdges(EdgeList& e, float height, float (&bounds)[4]) {
    const F f;
    const I i32;
    const VF rows = hn::Set(f, height + 1);
    VF bx0 = hn::Set(f, bounds[0]), by0 = hn::Set(f, bounds[1]), bx1 = hn::Set(f, bounds[2]),
       by1 = hn::Set(f, bounds[3]);
    e.pad();
    for (int k = 0; k < e.count; k += static_cast<int>(hn::Lanes(f))) {
        const VF ax = hn::Load(f, e.ax + k), ay = hn::Load(f, e.ay + k), bx = hn::Load(f, e.bx + k),
                 by = hn::Load(f, e.by + k), vr = hn::Load(f, e.r + k);
        const auto up = hn::Gt(by, ay);
        const VF yl = hn::Min(ay, by), yh = hn::Max(ay, by), xl = hn::IfThenElse(up, ax, bx),
                 xh = hn::IfThenElse(up, bx, ax);
        const VF run = hn::Sub(xh, xl), rise = hn::Sub(yh, yl);
        const auto level = hn::Lt(rise, hn::Set(f, 1e-6f));
        const VF slope = hn::IfThenElse(level, hn::Zero(f), hn::Div(run, rise));
        const VF steep = hn::Abs(slope);
        const VF error = hn::Mul(
            hn::Set(f, 0x1p-20f),
            hn::Add(hn::Mul(steep, hn::Add(hn::Abs(yl), hn::Set(f, height + 16))), hn::Add(hn::Abs(xl), hn::Abs(xh))));
        const VF grow = hn::Add(vr, error);
        const VF half = hn::Add(hn::Mul(steep, hn::Add(hn::Set(f, 0.5f), vr)), grow);
        const VF left = hn::Sub(hn::Min(ax, bx), grow), right = hn::Add(hn::Max(ax, bx), grow);
        hn::Store(xl, f, e.x + k);
        hn::Store(yl, f, e.y + k);
        hn::Store(slope, f, e.slope + k);
        hn::Store(hn::IfThenElse(level, hn::Add(hn::Abs(run), grow), half), f, e.half + k);
        hn::Store(left, f, e.left + k);
        hn::Store(right, f, e.right + k);
        const auto toRow = [&](VF v) HWY_ATTR {
            return hn::ConvertTo(i32, hn::Min(hn::Max(hn::Floor(v), hn::Set(f, -1.0f)), rows));
        };
        hn::Store(toRow(hn::Sub(yl, grow)), i32, e.first + k);
        hn::Store(toRow(hn::Add(yh, grow)), i32, e.last + k);
        // A row's middle is crossed if it lies in [yl, yh): the ceiling of y - 0.5.
        const auto crossed = [&](VF v) HWY_ATTR { return toRow(hn::Neg(hn::Floor(hn::Sub(hn::Set(f, 0.5f), v)))); };
        hn::Store(crossed(yl), i32, e.begin + k);
        hn::Store(crossed(yh), i32, e.end + k);
        hn::Store(hn::IfThenElse(hn::RebindMask(i32, up), hn::Set(i32, 1), hn::Zero(i32)), i32, e.up + k);
        hn::Store(hn::IfThenElse(hn::RebindMask(i32, level), hn::Set(i32, 1), hn::Zero(i32)), i32, e.level + k);
        hn::Store(hn::Add(hn::Add(hn::Mul(steep, vr), grow), hn::Set(f, 0.01f)), f, e.beside + k);
        bx0 = hn::Min(bx0, left);
        bx1 = hn::Max(bx1, right);
        by0 = hn::Min(by0, hn::Sub(yl, grow));
        by1 = hn::Max(by1, hn::Add(yh, grow));
    }
    bounds[0] = hn::GetLane(hn::MinOfLanes(f, bx0));
    bounds[1] = hn::GetLane(hn::MinOfLanes(f, by0));
    bounds[2] = hn::GetLane(hn::MaxOfLanes(f, bx1));
    bounds[3] = hn::GetLane(hn::MaxOfLanes(f, by1));
}

/// Of whole numbers from -2^22 to 2^22: where they are added to this, the last bits of the float are the number.
HWY_INLINE VI wholeOf(VF v) {
    const I i32;
    const F f;
    constexpr float kLast = 0x1.8p23f;
    return hn::Sub(hn::BitCast(i32, hn::Add(v, hn::Set(f, kLast))), hn::Set(i32, std::bit_cast<int32_t>(kLast)));
}

inline void setUpRow(const EdgeList& e, int i, int row0, float width, RowEdge& out) {
    const F f;
    const I i32;
    const VF slope = hn::Set(f, e.slope[i]), x0 = hn::Set(f, e.x[i]), y0 = hn::Set(f, e.y[i]);
    const VF half = hn::Set(f, e.half[i]), left = hn::Set(f, e.left[i]), right = hn::Set(f, e.right[i]);
    const VF beside = hn::Set(f, e.beside[i]), middle = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
    const auto clamp = [&](VF v) HWY_ATTR { return hn::Min(hn::Max(v, hn::Set(f, -1.0f)), hn::Set(f, width + 64)); };
    // The first pixel whose middle is not left of a place: the ceiling of x - 0.5.
    const auto atMiddle = [&](VF v) HWY_ATTR { return hn::Neg(hn::Floor(hn::Sub(middle, v))); };
    const bool level = e.level[i] != 0, plus = out.plus;
    for (size_t k = 0; k < kBlockHeight; k += hn::Lanes(f)) {
        const VF y = hn::Iota(f, static_cast<float>(row0) + 0.5f + static_cast<float>(k));
        const VF x = hn::Add(hn::Mul(hn::Sub(y, y0), slope), x0);
        hn::Store(wholeOf(clamp(atMiddle(hn::Min(hn::Max(x, left), right)))), i32, out.crossed + k);
        const VF first = hn::Floor(hn::Max(hn::Sub(x, half), left)),
                 end = hn::Add(hn::Floor(hn::Min(hn::Add(x, half), right)), one);
        // A level edge has all that it touches on its inner side.
        const VF inner = level  ? hn::Set(f, plus ? -1.0f : width + 64)
                         : plus ? atMiddle(hn::Sub(x, beside))
                                : hn::Add(hn::Floor(hn::Add(x, hn::Sub(beside, middle))), one);
        hn::Store(wholeOf(clamp(first)), i32, out.first + k);
        hn::Store(wholeOf(clamp(end)), i32, out.end + k);
        hn::Store(wholeOf(clamp(inner)), i32, out.inner + k);
    }
}

/// Sixteen edges in one row of blocks: which meet it, and where.
struct RowPlaces {
    alignas(64) int32_t first[16], last[16], begin[16], end[16];
    alignas(64) float low[16], high[16];
    uint32_t meets = 0;
};

/// @param beyond  what begins here or farther right does not matter
inline void placeEdges(const EdgeList& e, int at, int row0, float beyond, RowPlaces& out) {
    const F f;
    const I i32;
    out.meets = 0;
    for (size_t k = 0; k < 16; k += hn::Lanes(f)) {
        const size_t i = static_cast<size_t>(at) + k;
        const VI zero = hn::Zero(i32), top = hn::Set(i32, kBlockHeight), row = hn::Set(i32, row0);
        const auto inRow = [&](const int32_t* v, VI most)
                               HWY_ATTR { return hn::Min(hn::Max(hn::Sub(hn::Load(i32, v + i), row), zero), most); };
        const VI first = hn::Max(hn::Sub(hn::Load(i32, e.first + i), row), zero),
                 last = hn::Min(hn::Sub(hn::Load(i32, e.last + i), row), hn::Set(i32, kBlockHeight - 1));
        hn::Store(first, i32, out.first + k);
        hn::Store(last, i32, out.last + k);
        hn::Store(inRow(e.begin, top), i32, out.begin + k);
        hn::Store(inRow(e.end, top), i32, out.end + k);
        const VF middle = hn::Sub(hn::Set(f, static_cast<float>(row0) + 0.5f), hn::Load(f, e.y + i));
        const auto place = [&](VI of) HWY_ATTR {
            return hn::Add(hn::Mul(hn::Add(hn::ConvertTo(f, of), middle), hn::Load(f, e.slope + i)),
                           hn::Load(f, e.x + i));
        };
        const VF xa = place(first), xb = place(last), more = hn::Set(f, 0.01f);
        const VF room = hn::Add(hn::Add(hn::Load(f, e.half + i), more),
                                hn::Mul(hn::Set(f, 0x1p-20f), hn::Max(hn::Abs(xa), hn::Abs(xb))));
        const VF low = hn::Max(hn::Sub(hn::Min(xa, xb), room), hn::Sub(hn::Load(f, e.left + i), more));
        hn::Store(low, f, out.low + k);
        hn::Store(hn::Min(hn::Add(hn::Max(xa, xb), room), hn::Add(hn::Load(f, e.right + i), more)), f, out.high + k);
        const auto meets = hn::And(hn::Not(hn::RebindMask(f, hn::Gt(first, last))), hn::Lt(low, hn::Set(f, beyond)));
        uint8_t bits[8] = {};
        hn::StoreMaskBits(f, meets, bits);
        out.meets |= static_cast<uint32_t>(bits[0] | bits[1] << 8) << k;
    }
}

/// Ones from a column of the block on.
HWY_INLINE VU onesFrom(VI column, VI block) {
    const I i32;
    const U u32;
    const VI at = hn::Max(hn::Sub(column, block), hn::Zero(i32));
#if HWY_TARGET <= HWY_AVX2  // there what is shifted by more than there are bits is 0
    return hn::Shl(hn::Set(u32, ~0u), hn::BitCast(u32, at));
#else
    const auto inside = hn::RebindMask(u32, hn::Lt(at, hn::Set(i32, kBlockWidth)));
    return hn::IfThenElseZero(inside, hn::Shl(hn::Set(u32, ~0u), hn::BitCast(u32, hn::Min(at, hn::Set(i32, 31)))));
#endif
}

/// Adds an edge to winding numbers right of it.
template <size_t kPlanes>
HWY_INLINE void countEdge(VU (&plane)[kPlanes], VU more, bool plus) {
    for (VU& of : plane) {
        const VU carry = plus ? hn::And(of, more) : hn::AndNot(of, more);
        of = hn::Xor(of, more);
        more = carry;
    }
}

/// Some rows of a block, and an edge there.
struct BlockRows {
    VU bit;    ///< of each row, among rows as bits
    VI block;  ///< its first column
    size_t at;

    HWY_INLINE VU all(uint32_t rows) const { return hn::VecFromMask(U(), hn::TestBit(hn::Set(U(), rows), bit)); }
    HWY_INLINE VU right(const RowEdge& e) const {
        return hn::And(all(e.rows), onesFrom(hn::Load(I(), e.crossed + at), block));
    }
    HWY_INLINE VU touched(const RowEdge& e) const {
        return hn::And(all(e.touched_rows), hn::AndNot(onesFrom(hn::Load(I(), e.end + at), block),
                                                       onesFrom(hn::Load(I(), e.first + at), block)));
    }
};

/// The pixels of a block that are covered, and those that edges touch. From the middle of a pixel a straight way to any point
/// of it crosses only edges that touch the pixel, each once at most, and only one that has the middle on its inner side lowers
/// the winding number there, by one. So a pixel is covered if the winding number of its middle is larger than the number of such
/// edges. Rounding moves edges by no more than what they touch beside them: a middle that close counts as inside, whichever way
/// it was counted before.
/// @returns whether there are any
inline bool coverBlock(const BlockEdges& edges, const RowWinding<2>& before, int column, uint32_t* covered,
                       uint32_t* touched) {
    const U u32;
    VU any = hn::Zero(u32);
    for (size_t k = 0; k < kBlockHeight; k += hn::Lanes(u32)) {
        const BlockRows rows{hn::Shl(hn::Set(u32, 1u), hn::Iota(u32, static_cast<uint32_t>(k))), hn::Set(I(), column),
                             k};
        VU winding[2] = {rows.all(before.plane[0]), rows.all(before.plane[1])};
        VU once = hn::Zero(u32), twice = once,
           thrice = once;  // so often an edge touches from its inner side, or more often
        VU touch = once;
        for (int n = 0; n < edges.count; ++n) {
            const RowEdge& e = edges.row[edges.list[n]];
            countEdge(winding, rows.right(e), e.plus);
            const VU here = rows.touched(e), beyond = onesFrom(hn::Load(I(), e.inner + k), rows.block),
                     inner = e.plus ? hn::And(here, beyond) : hn::AndNot(beyond, here);
            touch = hn::Or(touch, here);
            thrice = hn::Or(thrice, hn::And(twice, inner));
            twice = hn::Or(twice, hn::And(once, inner));
            once = hn::Or(once, inner);
        }
        // The winding number is 1 to 3, or looks as if it were: what is four times covered counts as open.
        const VU low = winding[0], high = winding[1];
        const VU cover = hn::Or(hn::AndNot(once, hn::Or(low, high)),
                                hn::Or(hn::AndNot(twice, high), hn::AndNot(thrice, hn::And(high, low))));
        hn::Store(cover, u32, covered + k);
        hn::Store(hn::AndNot(cover, touch), u32, touched + k);
        any = hn::Or(any, hn::Or(cover, touch));
    }
    return !hn::AllTrue(u32, hn::Eq(any, hn::Zero(u32)));
}

/// From rows of 32 pixels to masks of tiles, bit 8 * row + column.
#if HWY_TARGET == HWY_SCALAR
inline void tilesOf(const uint32_t* rows, uint64_t* tiles) {
    for (int t = 0; t < kBlockTiles; ++t) {
        tiles[t] = 0;
        for (int y = 0; y < 8; ++y) tiles[t] |= uint64_t{rows[8 * (t / 4) + y] >> (8 * (t % 4)) & 255} << (8 * y);
    }
}
#else
inline void tilesOf(const uint32_t* rows, uint64_t* tiles) {
    const hn::FixedTag<uint8_t, 16> u8;
    const hn::FixedTag<uint32_t, 4> u32;
    const hn::FixedTag<uint64_t, 2> u64;
    alignas(16) static constexpr uint8_t kByTile[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
    const auto order = hn::Load(u8, kByTile);
    const auto four = [&](int first) HWY_ATTR {  // of four rows: bytes of the first tile, of the second, ...
        return hn::BitCast(u32, hn::TableLookupBytes(hn::BitCast(u8, hn::Load(u32, rows + first)), order));
    };
    for (int half = 0; half < 2; ++half) {
        const auto low = four(8 * half), high = four(8 * half + 4);
        hn::Store(hn::BitCast(u64, hn::InterleaveLower(u32, low, high)), u64, tiles + 4 * half);
        hn::Store(hn::BitCast(u64, hn::InterleaveUpper(u32, low, high)), u64, tiles + 4 * half + 2);
    }
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
