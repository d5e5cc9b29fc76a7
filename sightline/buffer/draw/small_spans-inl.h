// The pixels that many small polygons hold in each row, a lane for each polygon.
// SPDX-License-Identifier: MIT
//
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#if defined(SIGHTLINE_BUFFER_DRAW_SMALL_SPANS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_SMALL_SPANS_INL_H
#undef SIGHTLINE_BUFFER_DRAW_SMALL_SPANS_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_SMALL_SPANS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <hwy/highway.h>

#include "sightline/buffer/draw/small_polygons.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace small_polygons {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using VU = hn::Vec<U>;
using MF = hn::Mask<F>;
using MI = hn::Mask<I>;

// Sixteen polygons make a batch on every machine, however many of them a vector holds: what is decided for a batch,
// and the records' order, must not depend on the instruction set.
constexpr uint32_t kBatch = 16;

// The slope that stands for a level edge. Over 32 pixels it errs by 2^-12; and sixteen rows of it stay below 2^22,
// where a float still has its halves.
constexpr float kLevel = 0x1p17f;

// Snapping moves a corner by up to 2^-9. Sixteen sums of slopes are wrong by less than 2^-15 (1 + slope), a level edge
// by 2^-12.
constexpr float kRounding = 0x1p-9f + 0x1p-11f;

/// A task's polygons, corner by corner. Vertices are fetched by plain moves: gathers are slower, and some machines have
/// none. And ahead of their use, since a vector read waits long for narrow writes that it spans.
struct Parts {
    SnappedVertex corner[4][4][4][4];  ///< the fourth only in batches that have it; per batch: of the polygons 4 b + k
                                       ///< those with the least k first
    alignas(64) uint32_t both[64];     ///< 1: double-sided
    alignas(64) uint32_t three[64];    ///< 1: has three corners
    uint32_t quads = 0;                ///< bit per batch that has some with four corners

    explicit Parts(const SmallPolygonsTask& task) {
        const uint32_t count = task.count, padded = (count + kBatch - 1) / kBatch * kBatch;
        const auto fetch = [&](uint32_t p, const OccluderPolygon& polygon) {
            for (int k = 0; k < 3; ++k) at(k, p) = task.vertices[polygon.vertex[k]];
            both[p] = polygon.double_sided;
            three[p] = polygon.vertex[3] == OccluderPolygon::kNone;
        };
        for (uint32_t p = 0; p < count; ++p) fetch(p, task.polygons[p]);
        for (uint32_t p = count; p < padded; ++p) fetch(p, task.polygons[count - 1]);
        for (uint32_t first = 0; first < padded; first += kBatch) {
            uint32_t threes = 1;
            for (uint32_t p = first; p < first + kBatch; ++p) threes &= three[p];
            if (threes) continue;
            quads |= 1u << first / kBatch;
            for (uint32_t p = first; p < first + kBatch; ++p) {
                const uint8_t* vertex = task.polygons[std::min(p, count - 1)].vertex;
                at(3, p) = task.vertices[vertex[three[p] ? 2 : 3]];
            }
        }
    }
    SnappedVertex& at(int k, uint32_t p) { return corner[k][p / kBatch][p & 3][p % kBatch / 4]; }

    /// One corner of the polygons of a vector.
    HWY_INLINE void load(int k, size_t p, VI& x, VI& y, VF& d) const {
        const I i;
        const SnappedVertex* from = &corner[k][p / kBatch][p & 3][p % kBatch / 4];
#if HWY_TARGET == HWY_SCALAR
        x = hn::Set(i, from->x);
        y = hn::Set(i, from->y);
        d = hn::Set(F(), from->d);
#else
        const hn::Repartition<int64_t, I> l;
        const auto part = [&](int polygon) HWY_ATTR { return hn::Load(i, &from[4 * polygon].x); };
        const VI v0 = part(0), v1 = part(1), v2 = part(2), v3 = part(3);
        const auto xy01 = hn::BitCast(l, hn::InterleaveLower(i, v0, v1));
        const auto xy23 = hn::BitCast(l, hn::InterleaveLower(i, v2, v3));
        const auto d01 = hn::BitCast(l, hn::InterleaveUpper(i, v0, v1));
        const auto d23 = hn::BitCast(l, hn::InterleaveUpper(i, v2, v3));
        x = hn::BitCast(i, hn::InterleaveLower(l, xy01, xy23));
        y = hn::BitCast(i, hn::InterleaveUpper(l, xy01, xy23));
        d = hn::BitCast(F(), hn::InterleaveLower(l, d01, d23));
#endif
    }
};

/// The masks' order, as the transpose leaves them: the first two polygons of each four, and then the other two.
constexpr size_t placeOf(size_t polygon) { return (polygon & 2) * 4 + polygon / 4 * 2 + (polygon & 1); }

/// A batch on its way.
struct Batch {
    alignas(64) uint32_t rows[2][SmallPolygons::kRows][kBatch];  ///< spans: of inner and of outer pixels
    /// Inner or outer, of rows from 0 or from 8, per column of tiles.
    alignas(64) uint64_t half[2][2][SmallPolygons::kColumns][kBatch];
    alignas(64) uint64_t shift[kBatch];  ///< bits from a tile's lowest row to the polygon's
    alignas(64) uint64_t place[kBatch];  ///< in the lowest tile of the first column
    alignas(64) int32_t tile_x[kBatch], low[kBatch];

    uint32_t count = 0;    ///< polygons
    uint32_t large = 0;    ///< bit per polygon
    uint32_t cut = 0;      ///< bit per polygon whose window is not wholly inside the buffer
    uint32_t height = 0;   ///< rows that any needs
    uint32_t columns = 0;  ///< of tiles, that any needs
};

template <class D, class Mask>
HWY_INLINE uint32_t bitsOf(D d, Mask mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
}

/// The corners of a vector of polygons in pixels from their windows' corners; lanes that draw nothing are all zero.
struct Corners {
    VF x[4], y[4];
};

HWY_INLINE VI crossOf(VI ax, VI ay, VI bx, VI by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(bx, ay)); }

HWY_INLINE void exchange(MF swap, VF& a, VF& b) {
    const VF old = a;
    a = hn::IfThenElse(swap, b, a);
    b = hn::IfThenElse(swap, old, b);
}

/// Change of x from one row to the next along an edge.
HWY_INLINE VF slopeOf(VF dx, VF dy) {
    const F d;
    const MF level = hn::Eq(dy, hn::Zero(d));
    const VF slope = hn::Div(dx, hn::IfThenElse(level, hn::Set(d, 1.0f), dy));
    return hn::IfThenElse(level, hn::CopySign(hn::Set(d, kLevel), dx), slope);
}

/// Pixels from the one that a bound lies in or touches: those from round(bound) on.
HWY_INLINE VU pixelsFrom(VF bound) {
    const F d;
    const U u;
    // Adding this leaves the nearest whole number in the lowest bits.
    const VF magic = hn::Set(d, 0x1.8p23f);
    const VU from = hn::Sub(hn::BitCast(u, hn::Add(hn::Max(bound, hn::Zero(d)), magic)), hn::BitCast(u, magic));
    const VU ones = hn::Set(u, ~0u);
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
    return hn::Shl(ones, from);  // no bit is left where 32 or more are asked for
#else
    const VU most = hn::Set(u, 31);
    return hn::IfThenElseZero(hn::Lt(from, hn::Set(u, 32)), hn::Shl(ones, hn::Min(from, most)));
#endif
}

/// Pixels that the rows of the bounding box hold, as far as there are such.
struct BoxRows {
    VU columns, height;
    HWY_INLINE VU at(uint32_t row) const {
        const U u;
        return hn::IfThenElseZero(hn::Gt(height, hn::Set(u, row)), columns);
    }
};

/// The spans of triangles. Between their lowest and their highest corner each has one edge on one side and two on
/// the other; `mirrored` turns the sign of x where the two are on the right, so that they are on the left everywhere.
template <bool kOuter>
HWY_INLINE void triangleSpans(Corners& c, float reach, const BoxRows& box, Batch& batch, size_t h) {
    const F d;
    const U u;
    VF *x = c.x, *y = c.y;
    for (const int i : {0, 1, 0}) {
        const MF swap = hn::Lt(y[i + 1], y[i]);
        exchange(swap, x[i], x[i + 1]);
        exchange(swap, y[i], y[i + 1]);
    }
    // In 1/256 pixel all of this is exact.
    const I i;
    const VF fine = hn::Set(d, 256.0f);
    const auto side = [&](VF from, VF to) HWY_ATTR { return hn::ConvertTo(i, hn::Mul(hn::Sub(to, from), fine)); };
    const VI cross = crossOf(side(x[0], x[1]), side(y[0], y[1]), side(x[0], x[2]), side(y[0], y[2]));
    const VU mirrored = hn::BitCast(u, hn::VecFromMask(i, hn::Gt(cross, hn::Zero(i))));
    const VF sign = hn::BitCast(d, hn::And(mirrored, hn::Set(u, 0x80000000u)));

    const VF dx_a = hn::Sub(x[2], x[0]), dx_b = hn::Sub(x[1], x[0]), dx_c = hn::Sub(x[2], x[1]);
    const VF dy_a = hn::Sub(y[2], y[0]), dy_b = hn::Sub(y[1], y[0]), dy_c = hn::Sub(y[2], y[1]);
    const VF slope_a = slopeOf(dx_a, dy_a);
    VF slope_b = slopeOf(dx_b, dy_b), slope_c = slopeOf(dx_c, dy_c);
    const VF half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), wide = hn::Set(d, reach);
    const auto start = [&](VF px, VF py, VF slope) HWY_ATTR { return hn::Add(px, hn::Mul(slope, hn::Sub(half, py))); };
    const auto reachOf = [&](VF slope) HWY_ATTR { return hn::Mul(wide, hn::Add(one, hn::Abs(slope))); };
    const VF reach_b = reachOf(slope_b), reach_c = reachOf(slope_c);
    const VF reach_a = hn::Xor(reachOf(slope_a), sign);
    const VF at_a = start(x[0], y[0], slope_a);
    VF at_b = hn::Xor(start(x[0], y[0], slope_b), sign), at_c = hn::Xor(start(x[1], y[1], slope_c), sign);
    slope_b = hn::Xor(slope_b, sign);
    slope_c = hn::Xor(slope_c, sign);
    VF in_a = hn::Sub(at_a, reach_a), in_b = hn::Add(at_b, reach_b), in_c = hn::Add(at_c, reach_c);
    VF out_a = hn::Add(at_a, reach_a), out_b = hn::Sub(at_b, reach_b), out_c = hn::Sub(at_c, reach_c);
    if constexpr (kOuter) {
        // Two corners in one place make no edge.
        const VF free = hn::Set(d, -0x1p22f);
        const auto point = [&](VF dx, VF dy)
                               HWY_ATTR { return hn::Eq(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Zero(d)); };
        out_b = hn::IfThenElse(point(dx_b, dy_b), free, out_b);
        out_c = hn::IfThenElse(point(dx_c, dy_c), free, out_c);
        out_a = hn::IfThenElse(point(dx_a, dy_a), hn::Neg(hn::Xor(free, sign)), out_a);
    }
    const auto span = [&](VF a, VF b, VF cc) HWY_ATTR {
        const VU far = hn::Xor(pixelsFrom(a), mirrored);
        return hn::AndNot(far, hn::Xor(pixelsFrom(hn::Xor(hn::Max(b, cc), sign)), mirrored));
    };
    for (uint32_t row = 0; row < batch.height; ++row) {
        hn::Store(span(in_a, in_b, in_c), u, batch.rows[0][row] + h);
        in_a = hn::Add(in_a, slope_a);
        in_b = hn::Add(in_b, slope_b);
        in_c = hn::Add(in_c, slope_c);
        if constexpr (!kOuter) continue;
        hn::Store(hn::And(span(out_a, out_b, out_c), box.at(row)), u, batch.rows[1][row] + h);
        out_a = hn::Add(out_a, slope_a);
        out_b = hn::Add(out_b, slope_b);
        out_c = hn::Add(out_c, slope_c);
    }
}

/// The spans of convex polygons, counter-clockwise. Every edge is taken for a left one and for a right one, of which
/// one bounds nothing.
template <bool kOuter>
HWY_INLINE void quadSpans(const Corners& c, float reach, const BoxRows& box, Batch& batch, size_t h) {
    const F d;
    const U u;
    const VF half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), zero = hn::Zero(d), wide = hn::Set(d, reach);
    const VF free = hn::Set(d, -0x1p22f), most = hn::Set(d, 64.0f);
    VF left[2][4], right[2][4], slope[4];
    MF extended = hn::MaskFromVec(zero);  // has a side, and so no pixel inside where it has no area
    for (int e = 0; e < 4; ++e) {
        const int f = (e + 1) & 3;
        const VF dx = hn::Sub(c.x[f], c.x[e]), dy = hn::Sub(c.y[f], c.y[e]);
        // Down on the left, up on the right; a level edge is a left one, that falls by next to nothing.
        const MF up = hn::Gt(dy, zero), level = hn::Eq(dy, zero);
        const MF point = hn::And(level, hn::Eq(dx, zero));
        extended = hn::Or(extended, hn::Not(point));
        slope[e] = slopeOf(hn::IfThenElse(level, hn::Neg(dx), dx), dy);
        const VF at = hn::Add(c.x[e], hn::Mul(slope[e], hn::Sub(half, c.y[e])));
        const VF r = hn::Mul(wide, hn::Add(one, hn::Abs(slope[e])));
        const MF no_left = hn::Or(up, point), no_right = hn::Not(up);
        left[0][e] = hn::IfThenElse(no_left, free, hn::Add(at, r));
        left[1][e] = hn::IfThenElse(no_left, free, hn::Sub(at, r));
        right[0][e] = hn::IfThenElse(no_right, hn::Neg(free), hn::Sub(at, r));
        right[1][e] = hn::IfThenElse(no_right, hn::Neg(free), hn::Add(at, r));
    }
    const VU has_inner = hn::BitCast(u, hn::VecFromMask(d, extended));
    for (uint32_t row = 0; row < batch.height; ++row)
        for (int o = 0; o < (kOuter ? 2 : 1); ++o) {
            VF low = zero, high = most;
            for (int e = 0; e < 4; ++e) {
                low = hn::Max(low, left[o][e]);
                high = hn::Min(high, right[o][e]);
                left[o][e] = hn::Add(left[o][e], slope[e]);
                right[o][e] = hn::Add(right[o][e], slope[e]);
            }
            const VU span = hn::AndNot(pixelsFrom(high), pixelsFrom(low));
            const VU bits = hn::And(span, box.at(row));
            hn::Store(o ? bits : hn::And(bits, has_inner), u, batch.rows[o][row] + h);
        }
}

}  // namespace small_polygons
}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
