// Classifies many small polygons at once: their spans per row of pixels become masks per tile.
// SPDX-License-Identifier: MIT
//
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#if defined(SIGHTLINE_BUFFER_DRAW_SMALL_CLASSIFY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_SMALL_CLASSIFY_INL_H
#undef SIGHTLINE_BUFFER_DRAW_SMALL_CLASSIFY_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_SMALL_CLASSIFY_INL_H
#endif

#include "sightline/buffer/draw/small_spans-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace small_polygons {

/// What is known of the shape of a vector of polygons: which way round they are, and whether that is sure.
struct Shape {
    MI backward, drawn, large;
};

/// @param perimeter  sum of all sides' extents, which for a convex polygon is twice its box's
HWY_INLINE Shape shapeOf(const VI* x, const VI* y, VI perimeter, MI triangle, MI both, bool quads, bool outer,
                         bool reverse, int32_t slack) {
    const I i;
    // A triangle's doubled area is wrong by no more than this where its corners are by the slack.
    const VI most = hn::Mul(hn::Set(i, slack), hn::Add(perimeter, hn::Set(i, 6 * slack)));
    const VI least = hn::Neg(most), zero = hn::Zero(i);
    const auto area = [&](int a, int b, int c) HWY_ATTR {
        return crossOf(hn::Sub(x[b], x[a]), hn::Sub(y[b], y[a]), hn::Sub(x[c], x[a]), hn::Sub(y[c], y[a]));
    };
    const VI first = area(0, 1, 2);
    const MI front = reverse ? hn::Lt(first, least) : hn::Gt(first, most);
    const MI back = reverse ? hn::Gt(first, most) : hn::Lt(first, least);
    Shape shape;
    shape.backward = hn::Lt(first, zero);
    // Where nothing is sure, nothing is covered; but the polygon may still touch.
    shape.drawn = outer ? hn::Or(both, hn::Not(back)) : hn::Or(front, hn::And(both, back));
    shape.large = hn::MaskFromVec(zero);
    if (!quads) return shape;
    const VI second = area(0, 2, 3), third = area(0, 1, 3), fourth = area(1, 2, 3);
    const auto all = [&](VI lowest, VI others) HWY_ATTR {
        return hn::And(hn::And(hn::Gt(first, lowest), hn::Gt(second, lowest)),
                       hn::And(hn::Gt(third, others), hn::Gt(fourth, others)));
    };
    const auto none = [&](VI highest, VI others) HWY_ATTR {
        return hn::And(hn::And(hn::Lt(first, highest), hn::Lt(second, highest)),
                       hn::And(hn::Lt(third, others), hn::Lt(fourth, others)));
    };
    const VI one = hn::Set(i, 1);
    const MI forward = all(most, hn::Neg(one)), backward = none(least, one);
    const MI faces = hn::Or(both, reverse ? backward : forward);
    const MI sure = hn::Or(forward, backward);
    // Both halves away from the eye: nothing is drawn even if the quadrangle is not convex.
    const MI away = reverse ? hn::And(hn::Gt(first, most), hn::Gt(second, most))
                            : hn::And(hn::Lt(first, least), hn::Lt(second, least));
    shape.drawn = hn::Or(hn::And(triangle, shape.drawn), hn::AndNot(triangle, hn::And(sure, faces)));
    shape.large = hn::AndNot(triangle, hn::AndNot(sure, hn::Or(both, hn::Not(away))));
    return shape;
}

#if HWY_TARGET == HWY_SCALAR

/// Where the records go, in the transpose's order.
inline void notePlaces(VU polygon, VU tile, VU shift, Batch& batch, size_t h) {
    batch.place[placeOf(h)] = hn::GetLane(polygon) | uint64_t{hn::GetLane(tile)} << 32;
    batch.shift[placeOf(h)] = hn::GetLane(shift);
}

/// Turns eight rows of pixels of each polygon into columns of tiles: bytes of a row into 64-bit words.
inline void transposeRows(const uint32_t (*rows)[kBatch], size_t h, uint32_t columns, uint64_t (*out)[kBatch]) {
    for (uint32_t column = 0; column < columns; ++column) {
        uint64_t word = 0;
        for (int row = 0; row < 8; ++row) word |= uint64_t{rows[row][h] >> 8 * column & 255} << 8 * row;
        out[column][placeOf(h)] = word;
    }
}

#else

/// Where the records go, in the transpose's order.
HWY_INLINE void notePlaces(VU polygon, VU tile, VU shift, Batch& batch, size_t h) {
    const U u;
    const hn::Repartition<uint64_t, U> l;
    const size_t at = placeOf(h);
    hn::Store(hn::BitCast(l, hn::InterleaveLower(u, polygon, tile)), l, batch.place + at);
    hn::Store(hn::BitCast(l, hn::InterleaveUpper(u, polygon, tile)), l, batch.place + at + 8);
    hn::Store(hn::BitCast(l, hn::InterleaveLower(u, shift, hn::Zero(u))), l, batch.shift + at);
    hn::Store(hn::BitCast(l, hn::InterleaveUpper(u, shift, hn::Zero(u))), l, batch.shift + at + 8);
}

/// Four rows of pixels: of the polygons k, 4 + k ... a byte per row, the four of a column in a lane. References, since
/// some compilers copy arrays of vectors through memory.
HWY_INLINE void transposeFour(const uint32_t (*rows)[kBatch], size_t h, VU& p0, VU& p1, VU& p2, VU& p3) {
    const U u;
    const hn::Repartition<uint8_t, U> b;
    const hn::Repartition<uint16_t, U> w;
    const auto r0 = hn::BitCast(b, hn::Load(u, rows[0] + h)), r1 = hn::BitCast(b, hn::Load(u, rows[1] + h));
    const auto r2 = hn::BitCast(b, hn::Load(u, rows[2] + h)), r3 = hn::BitCast(b, hn::Load(u, rows[3] + h));
    const auto low01 = hn::BitCast(w, hn::InterleaveLower(b, r0, r1));
    const auto low23 = hn::BitCast(w, hn::InterleaveLower(b, r2, r3));
    const auto high01 = hn::BitCast(w, hn::InterleaveUpper(b, r0, r1));
    const auto high23 = hn::BitCast(w, hn::InterleaveUpper(b, r2, r3));
    p0 = hn::BitCast(u, hn::InterleaveLower(w, low01, low23));
    p1 = hn::BitCast(u, hn::InterleaveUpper(w, low01, low23));
    p2 = hn::BitCast(u, hn::InterleaveLower(w, high01, high23));
    p3 = hn::BitCast(u, hn::InterleaveUpper(w, high01, high23));
}

/// Turns eight rows of pixels of each polygon into columns of tiles: bytes of a row into 64-bit words.
HWY_INLINE void transposeRows(const uint32_t (*rows)[kBatch], size_t h, uint32_t columns, uint64_t (*out)[kBatch]) {
    const U u;
    const hn::Repartition<uint64_t, U> l;
    VU a0, a1, a2, a3, b0, b1, b2, b3;
    transposeFour(rows, h, a0, a1, a2, a3);
    transposeFour(rows + 4, h, b0, b1, b2, b3);
    const size_t at = placeOf(h);
    const auto put = [&](auto k0, auto k1, uint64_t* low, uint64_t* high) HWY_ATTR {
        hn::Store(hn::InterleaveLower(l, k0, k1), l, low);
        hn::Store(hn::InterleaveUpper(l, k0, k1), l, high);
    };
    const auto lower = [&](VU a, VU b) HWY_ATTR { return hn::BitCast(l, hn::InterleaveLower(u, a, b)); };
    put(lower(a0, b0), lower(a1, b1), out[0] + at, out[1] + at);
    put(lower(a2, b2), lower(a3, b3), out[0] + at + 8, out[1] + at + 8);
    if (columns <= 2) return;
    const auto upper = [&](VU a, VU b) HWY_ATTR { return hn::BitCast(l, hn::InterleaveUpper(u, a, b)); };
    put(upper(a0, b0), upper(a1, b1), out[2] + at, out[3] + at);
    put(upper(a2, b2), upper(a3, b3), out[2] + at + 8, out[3] + at + 8);
}

#endif  // HWY_SCALAR

/// Sets up and scans one vector of a batch's polygons, and notes their depths.
template <bool kOuter, bool kQuads>
HWY_INLINE void scanPolygons(const SmallPolygonsTask& task, const Parts& parts, uint32_t first, Batch& batch, size_t h,
                             SmallPolygons& out) {
    const F d;
    const I i;
    const U u;
    constexpr int kCorners = kQuads ? 4 : 3;
    const MI triangle = hn::Eq(hn::Load(i, reinterpret_cast<const int32_t*>(parts.three) + first + h), hn::Set(i, 1));
    VI x[4], y[4];
    VF nearness[4];
    for (int k = 0; k < kCorners; ++k) parts.load(k, first + h, x[k], y[k], nearness[k]);
    VI x0 = x[0], x1 = x[0], y0 = y[0], y1 = y[0];
    VF d0 = nearness[0], d1 = nearness[0];
    for (int k = 1; k < kCorners; ++k) {
        x0 = hn::Min(x0, x[k]), x1 = hn::Max(x1, x[k]);
        y0 = hn::Min(y0, y[k]), y1 = hn::Max(y1, y[k]);
        d0 = hn::Min(d0, nearness[k]), d1 = hn::Max(d1, nearness[k]);
    }
    // Snapping has moved the corners by half a step, and the slack is rounded up.
    const int32_t steps = static_cast<int32_t>(std::ceil(task.slack * 256.0f)) + 1;
    const VI slack = hn::Set(i, steps), zero = hn::Zero(i), one = hn::Set(i, 1);
    const MI near = hn::Eq(x0, hn::Set(i, SnappedVertex::kNone));
    const VI left = hn::ShiftRight<8>(hn::Sub(x0, slack)), right = hn::ShiftRight<8>(hn::Add(x1, slack));
    const VI low = hn::ShiftRight<8>(hn::Sub(y0, slack)), high = hn::ShiftRight<8>(hn::Add(y1, slack));
    const VI tile_x = hn::ShiftRight<3>(left), tile_y = hn::ShiftRight<3>(low);
    const VI last_column = hn::Set(i, static_cast<int32_t>(task.columns) - 1);
    const VI last_row = hn::Set(i, static_cast<int32_t>(task.rows) - 1);
    const MI there = hn::Lt(hn::Iota(i, static_cast<int32_t>(h)), hn::Set(i, static_cast<int32_t>(batch.count)));
    const MI beside =
        hn::Or(hn::Lt(hn::Min(right, high), zero), hn::Or(hn::Gt(tile_x, last_column), hn::Gt(tile_y, last_row)));
    const VI last_x = hn::ShiftRight<3>(right);
    const VI height = hn::Add(hn::Sub(high, low), one);
    const MI fits = hn::And(hn::Lt(hn::Sub(last_x, tile_x), hn::Set(i, SmallPolygons::kColumns)),
                            hn::Lt(height, hn::Set(i, SmallPolygons::kRows + 1)));
    const VI perimeter = hn::Add(hn::Sub(x1, x0), hn::Sub(y1, y0));
    const MI both = hn::Eq(hn::BitCast(i, hn::Load(u, parts.both + first + h)), one);
    const Shape shape =
        shapeOf(x, y, hn::Add(perimeter, perimeter), triangle, both, kQuads, kOuter, task.reverse, steps);
    const MI seen = hn::AndNot(near, hn::AndNot(beside, there));
    const MI small = hn::And(seen, fits), drawn = hn::AndNot(shape.large, hn::And(small, shape.drawn));
    const MI large = hn::Or(hn::And(there, near), hn::Or(hn::AndNot(fits, seen),
                                                         kQuads ? hn::And(small, shape.large) : hn::MaskFromVec(zero)));
    batch.large |= bitsOf(i, large) << h;

    // A window that reaches past the buffer.
    const VI last_y = hn::ShiftRight<3>(high);
    const MI cut =
        hn::Or(hn::Lt(hn::Min(tile_x, tile_y), zero), hn::Or(hn::Gt(last_x, last_column), hn::Gt(last_y, last_row)));
    batch.cut |= bitsOf(i, hn::And(drawn, cut)) << h;
    hn::Store(tile_x, i, batch.tile_x + h);
    hn::Store(low, i, batch.low + h);

    const VF error = hn::Set(d, task.depth_error * (1.0f + 0x1p-20f) + 0x1p-120f), tiny = hn::Set(d, 0x1p-22f);
    hn::StoreU(hn::Sub(hn::Sub(d0, hn::Mul(hn::Abs(d0), tiny)), error), d, out.farthest + first + h);
    hn::StoreU(hn::Add(hn::Add(d1, hn::Mul(hn::Abs(d1), tiny)), error), d, out.nearest + first + h);

    // Small places are exact in float.
    const VI from_x = hn::ShiftLeft<11>(tile_x), from_y = hn::ShiftLeft<8>(low);
    const VF step = hn::Set(d, 0x1p-8f);
    Corners c;
    for (int k = 0; k < kCorners; ++k) {
        c.x[k] = hn::Mul(hn::ConvertTo(d, hn::IfThenElseZero(drawn, hn::Sub(x[k], from_x))), step);
        c.y[k] = hn::Mul(hn::ConvertTo(d, hn::IfThenElseZero(drawn, hn::Sub(y[k], from_y))), step);
    }
    const VI rows_drawn = hn::IfThenElseZero(drawn, height);
    batch.height = std::max(batch.height, static_cast<uint32_t>(hn::GetLane(hn::MaxOfLanes(i, rows_drawn))));
    const VI across = hn::IfThenElseZero(drawn, hn::Sub(last_x, tile_x));
    const uint32_t columns = hn::AllFalse(i, hn::Gt(across, one))             ? 2
                             : hn::AllFalse(i, hn::Gt(across, hn::Set(i, 2))) ? 3
                                                                              : 4;
    batch.columns = std::max(batch.columns, columns);
    const auto bits = [&](VI from) HWY_ATTR {  // from column `from`, 0 to 31, on
        return hn::Shl(hn::Set(u, ~0u), hn::And(hn::BitCast(u, from), hn::Set(u, 31)));
    };
    const VI x_first = hn::Sub(left, hn::ShiftLeft<3>(tile_x)), x_last = hn::Sub(right, hn::ShiftLeft<3>(tile_x));
    const BoxRows box{hn::AndNot(hn::Add(bits(x_last), bits(x_last)), bits(x_first)), hn::BitCast(u, rows_drawn)};
    const float reach = 0.5f + task.slack + kRounding;
    if constexpr (kQuads) {
        const MF turn = hn::RebindMask(d, shape.backward);
        exchange(turn, c.x[1], c.x[3]);
        exchange(turn, c.y[1], c.y[3]);
        quadSpans<kOuter>(c, reach, box, batch, h);
    } else {
        triangleSpans<kOuter>(c, reach, box, batch, h);
    }

    notePlaces(hn::Add(hn::Iota(u, static_cast<uint32_t>(h)), hn::Set(u, first)),
               hn::BitCast(u, hn::Add(hn::Mul(tile_y, hn::Set(i, static_cast<int32_t>(task.stride))), tile_x)),
               hn::ShiftLeft<3>(hn::BitCast(u, hn::And(low, hn::Set(i, 7)))), batch, h);
}

/// Takes away the pixels outside the buffer.
template <bool kOuter>
void cutWindows(const SmallPolygonsTask& task, Batch& batch) {
    const int32_t height = static_cast<int32_t>(8 * task.rows), columns = static_cast<int32_t>(task.columns);
    for (uint32_t left = batch.cut; left; left &= left - 1) {
        const size_t lane = static_cast<size_t>(std::countr_zero(left)), at = placeOf(lane);
        for (int column = 0; column < SmallPolygons::kColumns; ++column)
            for (int part = 0; part < 2; ++part) {
                const int32_t x = batch.tile_x[lane] + column, y = batch.low[lane] + 8 * part;
                uint64_t keep = x < 0 || x >= columns || y <= -8 || y >= height ? 0 : ~uint64_t{0};
                if (keep && y < 0) keep <<= -8 * y;
                if (keep && y + 8 > height) keep &= ~uint64_t{0} >> 8 * (y + 8 - height);
                for (int o = 0; o < (kOuter ? 2 : 1); ++o) batch.half[o][part][column][at] &= keep;
            }
    }
}

/// For each set of eight lanes its members and then the others: three bits of each at every eighth bit.
struct CompressTable {
    uint64_t order[256];
    constexpr CompressTable() : order() {
        for (uint64_t set = 0; set < 256; ++set) {
            int at = 0;
            for (uint64_t members : {set, ~set & 255})
                for (uint64_t lane = 0; lane < 8; ++lane)
                    if (members >> lane & 1) order[set] |= lane << 8 * at++;
        }
    }
};
alignas(64) inline constexpr CompressTable kCompress;

/// Writes the chosen lanes of several vectors side by side. Vectors of eight have their own way here, for some compilers
/// copy Highway's table every time.
struct Compressor {
    using L = hn::CappedTag<uint64_t, 8>;
    using V = hn::Vec<L>;
    hn::Mask<L> chosen;
    V order;

    HWY_INLINE explicit Compressor(hn::Mask<L> mask) : chosen(mask) {
        const L l;
        if constexpr (hn::MaxLanes(L()) == 8) {
            const V bytes = hn::Set(l, kCompress.order[bitsOf(l, mask)]);
            order = hn::And(hn::Shr(bytes, hn::ShiftLeft<3>(hn::Iota(l, 0))), hn::Set(l, 7));
        }
    }
    HWY_INLINE void write(V v, uint64_t* to) const {
        const L l;
        if constexpr (hn::MaxLanes(L()) == 8) {
            hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(l, order)), l, to);
        } else {
            alignas(64) uint64_t lanes[8];
            hn::Store(v, l, lanes);
            for (uint32_t left = bitsOf(l, chosen); left; left &= left - 1) *to++ = lanes[std::countr_zero(left)];
        }
    }
};

/// Moves the masks of a batch to the tiles' own rows, and writes out those that have a pixel.
template <bool kOuter>
HWY_INLINE void writeRecords(const SmallPolygonsTask& task, const Batch& batch, SmallPolygons& out) {
    const hn::CappedTag<uint64_t, 8> l;
    using V = hn::Vec<decltype(l)>;
    uint32_t count = out.count;
    const V most = hn::Set(l, 56), zero = hn::Zero(l);
    const bool tall = batch.height > 8;
    for (uint32_t column = 0; column < batch.columns; ++column)
        for (uint32_t up = 0; up < (batch.height > 9 ? 3 : batch.height > 1 ? 2 : 1); ++up) {
            const uint64_t go = uint64_t{task.stride * up + column} << 32;
            for (size_t at = 0; at < kBatch; at += hn::Lanes(l)) {
                const V shift = hn::Load(l, batch.shift + at);
                const auto word = [&](int o) HWY_ATTR {
                    const uint64_t *low = batch.half[o][0][column] + at, *high = batch.half[o][1][column] + at;
                    const auto below = [&](const uint64_t* from) HWY_ATTR {  // in two steps: the second may be 56
                        return hn::Shr(hn::ShiftRight<8>(hn::Load(l, from)), hn::Sub(most, shift));
                    };
                    if (up == 0) return hn::Shl(hn::Load(l, low), shift);
                    if (up == 2) return below(high);
                    return tall ? hn::Or(hn::Shl(hn::Load(l, high), shift), below(low)) : below(low);
                };
                const V inner = word(0), outer = kOuter ? word(1) : inner;
                const auto some = hn::Ne(outer, zero);
                const size_t found = hn::CountTrue(l, some);
                const V place = hn::Add(hn::Load(l, batch.place + at), hn::Set(l, go));
                const Compressor to(some);
                to.write(inner, out.inner + count);
                if (kOuter) to.write(outer, out.outer + count);
                to.write(place, out.place + count);
                count += static_cast<uint32_t>(found);
            }
        }
    out.count = count;
}

/// Turns the rows of pixels that one vector of polygons holds, batch.height of them, into words per column of tiles.
template <bool kOuter>
HWY_INLINE void transposeSpans(Batch& batch, size_t h) {
    const U u;
    const uint32_t height = batch.height;
    for (int o = 0; o < (kOuter ? 2 : 1); ++o) {
        for (uint32_t row = height; row < (height + 7) / 8 * 8; ++row)
            hn::Store(hn::Zero(u), u, batch.rows[o][row] + h);
        for (uint32_t part = 0; part < 2; ++part) {
            alignas(64) static constexpr uint32_t kEmpty[8][kBatch] = {};
            const bool some = 8 * part < height;
            // A batch of several vectors may need more columns than are known of yet.
            transposeRows(some ? batch.rows[o] + 8 * part : kEmpty, h, hn::Lanes(u) == kBatch ? batch.columns : 4,
                          batch.half[o][part]);
        }
    }
}

template <bool kOuter>
HWY_INLINE void scanBatch(const SmallPolygonsTask& task, const Parts& parts, uint32_t first, Batch& batch,
                          SmallPolygons& out) {
    const size_t lanes = hn::Lanes(F());
    for (size_t h = 0; h < kBatch; h += lanes) {
        const uint32_t before = batch.height;
        batch.height = 0;
        if (parts.quads >> first / kBatch & 1) scanPolygons<kOuter, true>(task, parts, first, batch, h, out);
        else scanPolygons<kOuter, false>(task, parts, first, batch, h, out);
        const uint32_t height = batch.height;
        transposeSpans<kOuter>(batch, h);
        batch.height = std::max(before, height);
    }
}

}  // namespace small_polygons

/// Classifies the polygons of a task; see SmallPolygons.
/// @tparam kOuter  also records that only touch, and the outer masks; without them it takes three quarters of the time
template <bool kOuter>
HWY_INLINE void classifySmallPolygons(const SmallPolygonsTask& task, SmallPolygons& out) {
    namespace sp = small_polygons;
    out.count = out.large_count = 0;
    const sp::Parts parts(task);
    sp::Batch batch;
    for (uint32_t first = 0; first < task.count; first += sp::kBatch) {
        batch.count = std::min(sp::kBatch, task.count - first);
        batch.large = batch.cut = batch.height = batch.columns = 0;
        sp::scanBatch<kOuter>(task, parts, first, batch, out);
        if (batch.cut) sp::cutWindows<kOuter>(task, batch);
        if (batch.height) sp::writeRecords<kOuter>(task, batch, out);
        for (uint32_t left = batch.large; left; left &= left - 1)
            out.large[out.large_count++] = static_cast<uint8_t>(first + static_cast<uint32_t>(std::countr_zero(left)));
    }
}

/// Snaps projected vertices.
/// @param x,y,nearness  [size: count, rounded up to 8]; x is NaN before the near plane
/// @param out           [size: count, rounded up to 8]
HWY_INLINE void snapVertices(const double* x, const double* y, const double* nearness, uint32_t count,
                             SnappedVertex* out) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const hn::Rebind<int32_t, decltype(d)> i;
    const auto most = hn::Set(d, double{SnappedVertex::kFarthest}), least = hn::Neg(most);
    const auto fine = hn::Set(d, 256.0), whole = hn::Set(d, 0x1.8p52);
    const auto snap = [&](auto v) HWY_ATTR {
        const auto near = hn::Min(hn::Max(hn::Mul(v, fine), least), most);
        return hn::Sub(hn::Add(near, whole), whole);
    };
    for (size_t v = 0; v < count; v += hn::Lanes(d)) {
        const auto px = hn::LoadU(d, x + v), py = hn::LoadU(d, y + v);
        const auto none = hn::Or(hn::IsNaN(px), hn::IsNaN(py));
        const auto sx = hn::IfThenElse(none, hn::Set(d, double{SnappedVertex::kNone}), snap(px));
        const auto sy = hn::IfThenElse(none, hn::Zero(d), snap(py));
        const auto sd = hn::BitCast(i, hn::DemoteTo(f, hn::LoadU(d, nearness + v)));
        hn::StoreInterleaved4(hn::DemoteTo(i, sx), hn::DemoteTo(i, sy), sd, hn::Zero(i), i, &out[v].x);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
