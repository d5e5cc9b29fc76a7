// The polygons of a patch from snapped vertices, sixteen at once: which way they wind, and their depth per tile.
// SPDX-License-Identifier: MIT
//
// Moving the vertices of a patch moves them for all of its edges at once, so its polygons may be drawn from snapped
// vertices if what is within reach of an open edge grows by that much. There, areas are exact: no polygon that was
// chosen by its sign takes from the winding number, but for quadrangles whose image is folded.
#if defined(SIGHTLINE_BUFFER_DRAW_SMALL_FACES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_SMALL_FACES_INL_H
#undef SIGHTLINE_BUFFER_DRAW_SMALL_FACES_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_SMALL_FACES_INL_H
#endif

#include "sightline/buffer/draw/patch-inl.h"
#include "sightline/buffer/draw/small_classify-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kSnap = 0x1p-9;  // [pixels]: vertices move by that much, and so their reach grows

/// The polygons of a cluster as a patch needs them.
struct SmallFaces {
    static constexpr uint32_t kMost = 256;
    static constexpr int32_t kTiles = 8;  ///< that a small one meets at most, side by side or one above the other
    static constexpr int32_t kAligned = 4;

    int8_t turn[kMost + 16];  ///< which way it winds; 0: it is not drawn
    uint8_t folded[kMost + 16];
    int forward = 0, backward = 0;  ///< that are drawn: counter-clockwise, clockwise

    /// Where the polygon is small: the place in the scratch from which its tiles are counted, a multiple of kAligned,
    /// for what is read soon after it was written should be read in the same pieces; its columns, and how many rows.
    alignas(64) int32_t at[kMost], from[kMost], end[kMost], up[kMost];
    /// It is no farther than the floor anywhere, and than start + i * right + j * above in the tile (i, j) of those.
    alignas(64) float floor[kMost], start[kMost], right[kMost], above[kMost];

    uint32_t small_count = 0, large_count = 0;
    uint8_t small[kMost];  ///< those that are small, drawn, and meet the patch's tiles
    uint8_t large[kMost];  ///< those that are not small
};

/// Bits of the polygons of one vector.
struct Sizes {
    uint32_t small, drawn;  ///< drawn: of the small ones, those that are, and meet the patch's tiles
};

/// Sets up one vector of polygons.
/// @param at     the first of them, among the task's
/// @param first  the task's first, in `out`
template <bool kQuads>
HWY_INLINE Sizes setUpFaces(const Patch& patch, const SmallPolygonsTask& task, const small_polygons::Parts& parts,
                            uint32_t at, uint32_t first, SmallFaces& out) {
    using namespace small_polygons;
    const F d;
    const I i;
    const hn::Rebind<int8_t, I> i8;
    constexpr int kCorners = kQuads ? 4 : 3, kLast = kCorners - 1;
    VI x[4], y[4];
    VF z[4];
    for (int k = 0; k < kCorners; ++k) parts.load(k, at, x[k], y[k], z[k]);
    const VI corner_x = hn::Set(i, patch.column0 * 2048), corner_y = hn::Set(i, patch.row0 * 2048);
    VI x0 = x[0], x1 = x[0], y0 = y[0], y1 = y[0];
    VF z0 = z[0], z1 = z[0];
    for (int k = 1; k < kCorners; ++k) {
        x0 = hn::Min(x0, x[k]), x1 = hn::Max(x1, x[k]);
        y0 = hn::Min(y0, y[k]), y1 = hn::Max(y1, y[k]);
        z0 = hn::Min(z0, z[k]), z1 = hn::Max(z1, z[k]);
    }
    const VI zero = hn::Zero(i), one = hn::Set(i, 1),
             steps = hn::Set(i, static_cast<int32_t>(std::ceil(patch.reach * 256.0)) + 1);
    const auto tileOf = [&](VI v, VI corner) HWY_ATTR { return hn::ShiftRight<11>(hn::Sub(v, corner)); };
    const VI left = tileOf(hn::Sub(x0, steps), corner_x), right = tileOf(hn::Add(x1, steps), corner_x);
    const VI low = tileOf(hn::Sub(y0, steps), corner_y), high = tileOf(hn::Add(y1, steps), corner_y);
    const VI most = hn::Set(i, SmallFaces::kTiles);
    const MI small = hn::And(hn::Lt(hn::Sub(right, left), most), hn::Lt(hn::Sub(high, low), most));

    // Twice the areas of both halves; exact where the polygon is small.
    const auto from = [&](const VI* v, int k) HWY_ATTR { return hn::Sub(v[k], v[0]); };
    const VI x10 = from(x, 1), y10 = from(y, 1), x20 = from(x, 2), y20 = from(y, 2), x30 = from(x, kLast),
             y30 = from(y, kLast);
    const VI half = crossOf(x10, y10, x20, y20), other = kQuads ? crossOf(x20, y20, x30, y30) : zero;
    const VI area = hn::Add(half, other), front = hn::Set(i, task.reverse ? -1 : 1);
    const MI forward = hn::Gt(area, zero), backward = hn::Lt(area, zero);
    VI turn = hn::IfThenElse(forward, one, hn::IfThenElse(backward, hn::Set(i, -1), front));
    const MI both = hn::Eq(hn::Load(i, reinterpret_cast<const int32_t*>(parts.both) + at), one);
    turn = hn::IfThenElseZero(hn::Or(both, hn::Eq(turn, front)), turn);
    hn::StoreU(hn::DemoteTo(i8, turn), i8, out.turn + first + at);
    const MI folded =
        hn::Or(hn::And(hn::Lt(half, zero), hn::Gt(other, zero)), hn::And(hn::Gt(half, zero), hn::Lt(other, zero)));
    hn::StoreU(hn::DemoteTo(i8, hn::IfThenElseZero(folded, one)), i8,
               reinterpret_cast<int8_t*>(out.folded + first + at));

    const VI c0 = hn::Max(left, zero), c1 = hn::Min(right, hn::Set(i, patch.columns - 1));
    const VI r0 = hn::Max(low, zero), r1 = hn::Min(high, hn::Set(i, patch.rows - 1));
    const VI aligned = hn::And(c0, hn::Set(i, -SmallFaces::kAligned));
    hn::Store(hn::Add(hn::Mul(r0, hn::Set(i, static_cast<int32_t>(patch.pitch))), aligned), i, out.at + first + at);
    hn::Store(hn::Sub(c0, aligned), i, out.from + first + at);
    hn::Store(hn::Sub(hn::Add(c1, one), aligned), i, out.end + first + at);
    hn::Store(hn::Sub(hn::Add(r1, one), r0), i, out.up + first + at);
    const MI outside = hn::Or(hn::Lt(c1, c0), hn::Lt(r1, r0));
    const MI beside = hn::Or(hn::Lt(c1, hn::Set(i, patch.open_first)), hn::Gt(c0, hn::Set(i, patch.open_last)));
    const MI hidden = hn::Or(hn::Lt(r1, hn::Set(i, patch.open_low)), hn::Gt(r0, hn::Set(i, patch.open_high)));
    const MI missed = hn::Or(outside, hn::Or(beside, hidden));
    const Sizes sizes{bitsOf(i, small), bitsOf(i, hn::AndNot(missed, hn::And(small, hn::Ne(turn, zero))))};
    if (!sizes.drawn) return sizes;

    // Any plane will do: it is lowered below the corners. So is each point of both halves below it, but for what the
    // plane changes between the true corners and these. The plane is that of the greater half.
    const VF step = hn::Set(d, 0x1p-8f), none = hn::Zero(d);
    const auto pixels = [&](VI v) HWY_ATTR { return hn::Mul(hn::ConvertTo(d, v), step); };
    const MI first_half = hn::Not(hn::Lt(hn::Abs(half), hn::Abs(other)));
    const VI bx = hn::IfThenElse(first_half, x10, x30), by = hn::IfThenElse(first_half, y10, y30);
    const VF ex = pixels(x20), ey = pixels(y20), fx = pixels(bx), fy = pixels(by), ez = hn::Sub(z[2], z[0]);
    const VF fz = hn::Sub(hn::IfThenElse(hn::RebindMask(d, first_half), z[1], z[kLast]), z[0]);
    const VF span = hn::Sub(hn::Mul(ex, fy), hn::Mul(ey, fx));
    const MF flat = hn::RebindMask(d, hn::And(small, hn::Ne(hn::IfThenElse(first_half, half, other), zero)));
    const VF divisor = hn::IfThenElse(flat, span, hn::Set(d, 1.0f));
    const VF gx = hn::IfThenElseZero(flat, hn::Div(hn::Sub(hn::Mul(ez, fy), hn::Mul(fz, ey)), divisor));
    const VF gy = hn::IfThenElseZero(flat, hn::Div(hn::Sub(hn::Mul(ex, fz), hn::Mul(fx, ez)), divisor));
    VF drop = none;
    for (int k = 1; k < kCorners; ++k) {
        const VF rise = hn::Add(hn::Mul(gx, pixels(from(x, k))), hn::Mul(gy, pixels(from(y, k))));
        drop = hn::Max(drop, hn::Sub(rise, hn::Sub(z[k], z[0])));
    }
    const auto offset = [&](VI tile, VI corner, VI v) HWY_ATTR {
        return pixels(hn::Sub(hn::Add(hn::ShiftLeft<11>(tile), hn::Set(i, 1024)), hn::Sub(v, corner)));
    };
    const VF tilt = hn::Add(hn::Abs(gx), hn::Abs(gy));
    const VF size = hn::Max(hn::Abs(z0), hn::Abs(z1));
    // Some twenty roundings, of values below this: no place is farther than 128 pixels from the first corner.
    const VF rounding = hn::Mul(hn::Set(d, 0x1p-18f), hn::Add(size, hn::Mul(hn::Set(d, 128.0f), tilt)));
    const VF error = hn::Set(d, task.depth_error * (1.0f + 0x1p-20f) + 0x1p-120f);
    const VF slope = hn::Add(hn::Mul(gx, offset(aligned, corner_x, x[0])), hn::Mul(gy, offset(r0, corner_y, y[0])));
    const VF below = hn::Add(hn::Mul(tilt, hn::Set(d, 4.0f + static_cast<float>(patch.reach) * (1.0f + 0x1p-20f))),
                             hn::Add(drop, hn::Add(rounding, error)));
    hn::Store(hn::Sub(hn::Add(z[0], slope), below), d, out.start + first + at);
    hn::Store(hn::Mul(gx, hn::Set(d, 8.0f)), d, out.right + first + at);
    hn::Store(hn::Mul(gy, hn::Set(d, 8.0f)), d, out.above + first + at);
    hn::Store(hn::Sub(hn::Sub(z0, hn::Mul(hn::Abs(z0), hn::Set(d, 0x1p-22f))), error), d, out.floor + first + at);
    return sizes;
}

/// Which way a large polygon winds, twice its area with a sign; exact.
inline int64_t areaOf(const SnappedVertex* v, const OccluderPolygon& polygon, bool& folded) {
    const SnappedVertex a = v[polygon.vertex[0]], b = v[polygon.vertex[1]], c = v[polygon.vertex[2]];
    const SnappedVertex e = polygon.corners() == 4 ? v[polygon.vertex[3]] : c;
    const auto cross = [&](const SnappedVertex& p, const SnappedVertex& q) {
        return int64_t{p.x - a.x} * (q.y - a.y) - int64_t{q.x - a.x} * (p.y - a.y);
    };
    const int64_t half = cross(b, c), other = cross(c, e);
    folded = (half < 0 && other > 0) || (half > 0 && other < 0);
    return half + other;
}

/// Finds which polygons are drawn, and the depth of those that are small.
/// @param task  all of the cluster's polygons
inline void setUpFaces(const Patch& patch, const SmallPolygonsTask& task, SmallFaces& out) {
    out.small_count = out.large_count = 0;
    for (uint32_t first = 0; first < task.count; first += 64) {
        SmallPolygonsTask part = task;
        part.polygons += first;
        part.count = std::min(64u, task.count - first);
        const small_polygons::Parts parts(part);
        const uint32_t lanes = static_cast<uint32_t>(hn::Lanes(small_polygons::I()));
        for (uint32_t at = 0; at < part.count; at += lanes) {
            const bool quads = parts.quads >> at / small_polygons::kBatch & 1;
            const Sizes sizes = quads ? setUpFaces<true>(patch, part, parts, at, first, out)
                                      : setUpFaces<false>(patch, part, parts, at, first, out);
            const uint32_t there = part.count - at < lanes ? (1u << (part.count - at)) - 1 : (1u << lanes) - 1;
            const auto note = [&](uint32_t bits, uint8_t* list, uint32_t& count) {
                for (; bits; bits &= bits - 1)
                    list[count++] = static_cast<uint8_t>(first + at + static_cast<uint32_t>(std::countr_zero(bits)));
            };
            note(sizes.drawn & there, out.small, out.small_count);
            note(~sizes.small & there, out.large, out.large_count);
        }
    }
    const int8_t front = task.reverse ? -1 : 1;
    for (uint32_t i = 0; i < out.large_count; ++i) {
        const uint32_t p = out.large[i];
        bool folded;
        const int64_t area = areaOf(task.vertices, task.polygons[p], folded);
        const int8_t turn = area > 0 ? 1 : area < 0 ? -1 : front;
        out.turn[p] = turn == front || task.polygons[p].double_sided ? turn : 0;
        out.folded[p] = folded;
    }
    for (uint32_t p = task.count; p < SmallFaces::kMost; ++p) out.turn[p] = 0;
    // The winding number of a pixel, which counts in a byte, stays above -128 for sure.
    int folded = 0;
    for (uint32_t p = 0; p < task.count; ++p) folded += out.folded[p];
    if (folded > 64)
        for (uint32_t p = 0; p < task.count; ++p) out.turn[p] = out.folded[p] ? 0 : out.turn[p];
    out.forward = out.backward = 0;
    for (uint32_t p = 0; p < task.count; ++p) {
        out.forward += out.turn[p] > 0;
        out.backward += out.turn[p] < 0;
    }
}

/// Lowers the depth of the tiles that the small polygons of one winding meet to their own. Where nothing else does,
/// those tiles have no plane.
HWY_INLINE void addDepths(Patch& patch, const SmallFaces& faces, int8_t turn) {
    const hn::CappedTag<float, SmallFaces::kAligned> d;
    const auto none = hn::Set(d, std::numeric_limits<float>::infinity());
    float* const depths = patch.tiles.scratch.z.data();
    for (uint32_t k = 0; k < faces.small_count; ++k) {
        const uint32_t p = faces.small[k];
        if (faces.turn[p] != turn) continue;
        const int32_t end = faces.end[p], up = faces.up[p];
        const auto floor = hn::Set(d, faces.floor[p]), right = hn::Set(d, faces.right[p]);
        const auto from = hn::Set(d, static_cast<float>(faces.from[p])), to = hn::Set(d, static_cast<float>(end));
        const float above = faces.above[p];
        for (int32_t i = 0; i < end; i += static_cast<int32_t>(hn::Lanes(d))) {
            const auto column = hn::Iota(d, static_cast<float>(i));
            const auto there = hn::AndNot(hn::Lt(column, from), hn::Lt(column, to));
            const auto start = hn::Add(hn::Set(d, faces.start[p]), hn::Mul(column, right));
            float* row = depths + faces.at[p] + i;
            for (int32_t j = 0; j < up; ++j, row += patch.pitch) {
                const auto z = hn::Max(hn::Add(start, hn::Set(d, static_cast<float>(j) * above)), floor);
                hn::StoreU(hn::Min(hn::LoadU(d, row), hn::IfThenElse(there, z, none)), d, row);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
