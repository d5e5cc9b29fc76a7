// The small open edges of a patch from snapped vertices, sixteen at once: pixels that they touch, and crossings.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_SMALL_EDGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_SMALL_EDGES_INL_H
#undef SIGHTLINE_BUFFER_DRAW_SMALL_EDGES_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_SMALL_EDGES_INL_H
#endif

#include "sightline/buffer/draw/open_edges-inl.h"
#include "sightline/buffer/draw/small_classify-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Open edges between snapped vertices, as they are gathered.
struct SmallEdges {
    static constexpr uint32_t kMost = 1024;
    alignas(64) int32_t ax[kMost + 16], ay[kMost + 16], bx[kMost + 16], by[kMost + 16];
    int8_t change[kMost + 16];  ///< as OpenEdges::change
    uint32_t count = 0;
};

/// Scans one vector of edges: spans of the pixels that they touch, and the pixels in which they cross a row's centres.
/// @returns bits of those that run upward
HWY_INLINE uint32_t scanEdges(const Patch& patch, const SmallEdges& edges, uint32_t first, small_polygons::Batch& batch,
                              size_t h) {
    using namespace small_polygons;
    const F d;
    const I i;
    const U u;
    const VI ax = hn::Load(i, edges.ax + first + h), ay = hn::Load(i, edges.ay + first + h);
    const VI bx = hn::Load(i, edges.bx + first + h), by = hn::Load(i, edges.by + first + h);
    const MI upward = hn::Not(hn::Gt(ay, by));
    const VI corner_x = hn::Set(i, patch.column0 * 2048), corner_y = hn::Set(i, patch.row0 * 2048);
    const VI x0 = hn::Sub(hn::Min(ax, bx), corner_x), x1 = hn::Sub(hn::Max(ax, bx), corner_x);
    const VI y0 = hn::Sub(hn::Min(ay, by), corner_y), y1 = hn::Sub(hn::Max(ay, by), corner_y);
    const VI x_low = hn::Sub(hn::IfThenElse(upward, ax, bx), corner_x);
    const VI x_high = hn::Sub(hn::IfThenElse(upward, bx, ax), corner_x);
    const VI zero = hn::Zero(i), one = hn::Set(i, 1);
    const VI steps = hn::Set(i, static_cast<int32_t>(std::ceil(patch.reach * 256.0)) + 1);
    const VI left = hn::ShiftRight<11>(hn::Sub(x0, steps)), right = hn::ShiftRight<11>(hn::Add(x1, steps));
    const VI low = hn::ShiftRight<8>(hn::Sub(y0, steps)), high = hn::ShiftRight<8>(hn::Add(y1, steps));
    const VI columns = hn::Set(i, patch.columns), rows = hn::Set(i, 8 * patch.rows);
    const MI there = hn::Lt(hn::Iota(i, static_cast<int32_t>(h)), hn::Set(i, static_cast<int32_t>(batch.count)));
    // What lies on the right of all tiles that matter changes nothing in them.
    const MI beside =
        hn::Or(hn::Lt(high, hn::Set(i, 8 * patch.open_low)),
               hn::Or(hn::Gt(left, hn::Set(i, patch.open_last)), hn::Gt(low, hn::Set(i, 8 * patch.open_high + 7))));
    const VI across = hn::Sub(right, left), height = hn::Add(hn::Sub(high, low), one);
    const MI fits = hn::And(hn::Lt(across, hn::Set(i, SmallPolygons::kColumns)),
                            hn::Lt(height, hn::Set(i, SmallPolygons::kRows + 1)));
    const MI inside = hn::AndNot(hn::Lt(hn::Min(left, low), zero), hn::And(hn::Lt(right, columns), hn::Lt(high, rows)));
    const MI seen = hn::AndNot(beside, there), drawn = hn::And(seen, hn::And(fits, inside));
    batch.large |= bitsOf(i, hn::AndNot(drawn, seen)) << h;

    // Small places are exact in float.
    const VF step = hn::Set(d, 0x1p-8f);
    const auto pixels = [&](VI v) HWY_ATTR { return hn::Mul(hn::ConvertTo(d, hn::IfThenElseZero(drawn, v)), step); };
    const VI from_x = hn::ShiftLeft<11>(left), from_y = hn::ShiftLeft<8>(low);
    const VI y_low = hn::Sub(y0, from_y), y_high = hn::Sub(y1, from_y);
    const VF run = pixels(hn::Sub(x_high, x_low)), rise = pixels(hn::Sub(y1, y0));
    const MF level = hn::Eq(rise, hn::Zero(d));
    const VF slope = hn::IfThenElseZero(hn::Not(level), hn::Div(run, hn::IfThenElse(level, hn::Set(d, 1.0f), rise)));
    // A slope of 2^13 at most is wrong by 2^-11 at most, and a place by that and 16 times as many steps of float as
    // the slope has: much less than 2^-11 of the slope.
    const float reach = static_cast<float>(patch.reach) * (1.0f + 0x1p-20f) + 0x1p-11f;
    const VF half = hn::IfThenElse(level, hn::Set(d, 64.0f),
                                   hn::Add(hn::Mul(hn::Abs(slope), hn::Set(d, 0.5f + reach)), hn::Set(d, reach)));
    const VF least = hn::Max(hn::Sub(pixels(hn::Sub(x0, from_x)), hn::Set(d, reach)), hn::Zero(d));
    const VF most = hn::Min(hn::Add(pixels(hn::Sub(x1, from_x)), hn::Set(d, reach)), hn::Set(d, 31.0f));
    const VF start = hn::Add(pixels(hn::Sub(x_low, from_x)), hn::Mul(hn::Sub(hn::Set(d, 0.5f), pixels(y_low)), slope));
    const VI rows_drawn = hn::IfThenElseZero(drawn, height);
    const uint32_t tall = static_cast<uint32_t>(hn::GetLane(hn::MaxOfLanes(i, rows_drawn)));
    batch.height = std::max(batch.height, tall);
    const VI wide = hn::IfThenElseZero(drawn, across);
    batch.columns = std::max(batch.columns, hn::AllFalse(i, hn::Gt(wide, one))             ? 2u
                                            : hn::AllFalse(i, hn::Gt(wide, hn::Set(i, 2))) ? 3u
                                                                                           : 4u);
    const VU ones = hn::Set(u, ~0u), all_but_one = hn::Set(u, ~1u), single = hn::Set(u, 1u);
    const auto column = [&](VF v) HWY_ATTR { return hn::BitCast(u, hn::ConvertTo(i, v)); };
    for (uint32_t row = 0; row < tall; ++row) {
        const VF at = hn::Add(start, hn::Mul(hn::Set(d, static_cast<float>(row)), slope));
        const VF from = hn::Min(hn::Max(hn::Sub(at, half), least), hn::Set(d, 31.0f));
        const VF to = hn::Max(hn::Min(hn::Add(at, half), most), hn::Zero(d));
        const VU touched = hn::AndNot(hn::Shl(all_but_one, column(to)), hn::Shl(ones, column(from)));
        const MI met = hn::Gt(rows_drawn, hn::Set(i, static_cast<int32_t>(row)));
        hn::Store(hn::IfThenElseZero(hn::RebindMask(u, met), touched), u, batch.rows[1][row] + h);
        // The same test of both ends for all edges: where one ends the next begins.
        const VI center = hn::Set(i, static_cast<int32_t>(256 * row + 128));
        const MI crossed = hn::And(met, hn::AndNot(hn::Gt(y_low, center), hn::Gt(y_high, center)));
        const VF place = hn::Min(hn::Max(at, least), most);
        const VU crossing = hn::Shl(single, column(place));
        const VU change = hn::IfThenElseZero(hn::RebindMask(u, crossed), crossing);
        hn::Store(change, u, batch.rows[0][row] + h);
    }
    const VI tile = hn::Add(hn::Mul(hn::ShiftRight<3>(low), hn::Set(i, static_cast<int32_t>(patch.pitch))), left);
    notePlaces(hn::Iota(u, static_cast<uint32_t>(h)), hn::BitCast(u, tile),
               hn::ShiftLeft<3>(hn::BitCast(u, hn::And(low, hn::Set(i, 7)))), batch, h);
    return bitsOf(i, upward);
}

/// Adds a number to the bytes of a tile that a mask names.
HWY_INLINE void addToBytes(uint8_t* bytes, uint64_t mask, uint8_t by) {
    const hn::CappedTag<uint8_t, 64> d;
    if constexpr (hn::MaxLanes(hn::CappedTag<uint8_t, 64>()) < 32) {
        for (; mask; mask &= mask - 1) {
            uint8_t& byte = bytes[std::countr_zero(mask)];
            byte = static_cast<uint8_t>(byte + by);
        }
    } else {
        uint8_t bits[8];
        std::memcpy(bits, &mask, sizeof mask);
        for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
            const auto chosen = hn::LoadMaskBits(d, bits + i / 8);
            hn::StoreU(hn::Add(hn::LoadU(d, bytes + i), hn::IfThenElseZero(chosen, hn::Set(d, by))), d, bytes + i);
        }
    }
}

/// Notes small open edges in the scratch, and hands on those that are large, or not wholly within the patch's tiles.
inline void addSmallEdges(Patch& patch, SmallEdges& edges, OpenEdges& large) {
    using namespace small_polygons;
    DepthTiles::Scratch& scratch = patch.tiles.scratch;
    SmallPolygonsTask task;
    task.stride = patch.pitch;
    SmallPolygons records;
    Batch batch;
    for (uint32_t k = edges.count; k < (edges.count + 15) / 16 * 16; ++k)
        edges.ax[k] = edges.ay[k] = edges.bx[k] = edges.by[k] = 0;  // read, but not used
    for (uint32_t first = 0; first < edges.count; first += kBatch) {
        batch.count = std::min(kBatch, edges.count - first);
        batch.large = batch.height = batch.columns = 0;
        uint32_t upward = 0, backward = 0;  // bit per edge
        for (uint32_t k = 0; k < batch.count; ++k) backward |= static_cast<uint32_t>(edges.change[first + k] < 0) << k;
        for (size_t h = 0; h < kBatch; h += hn::Lanes(F())) {
            const uint32_t before = batch.height;
            batch.height = 0;
            upward |= scanEdges(patch, edges, first, batch, h) << h;
            transposeSpans<true>(batch, h);
            batch.height = std::max(before, batch.height);
        }
        for (uint32_t left = batch.large; left; left &= left - 1) {
            const uint32_t k = first + static_cast<uint32_t>(std::countr_zero(left));
            const auto pixels = [](int32_t v) { return v * 0x1p-8; };
            large.add(pixels(edges.ax[k]), pixels(edges.ay[k]), pixels(edges.bx[k]), pixels(edges.by[k]),
                      edges.change[k]);
        }
        if (!batch.height) continue;
        records.count = 0;
        writeRecords<true>(task, batch, records);
        reserveSlots(patch, records.count);
        for (uint32_t r = 0; r < records.count; ++r) {
            const uint32_t slot = slotOf(patch, records.tile(r)), k = records.polygon(r);
            scratch.touched[slot] |= records.outer[r];
            if (!records.inner[r]) continue;
            addToBytes(scratch.winding.data() + 64 * size_t{slot}, records.inner[r],
                       ((backward ^ upward) >> k & 1) != 0 ? 0xff : 0x01);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
