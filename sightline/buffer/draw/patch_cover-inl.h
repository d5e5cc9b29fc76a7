// Carries a patch from its scratch into the tiles: which pixels it covers, and which its open edges leave in doubt.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_PATCH_COVER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_PATCH_COVER_INL_H
#undef SIGHTLINE_BUFFER_DRAW_PATCH_COVER_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_PATCH_COVER_INL_H
#endif

#include "sightline/buffer/draw/open_edges-inl.h"
#include "sightline/buffer/draw/patch_depth-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The planes that a patch's polygons lie on in a tile, by the scratch; none if they are too many, or one has none.
HWY_INLINE PlaneSet planesAt(const DepthTiles::Scratch& scratch, size_t at) {
    return scratch.plane[at] == DepthTiles::kNone ? PlaneSet() : PlaneSet(scratch.plane[at], scratch.second_plane[at]);
}

/// Covers whole tiles of a row that no open edge meets.
/// @param tile   the first
/// @param at     its place in the scratch
HWY_INLINE void coverRun(DepthTiles& tiles, uint32_t tile, size_t at, uint32_t count) {
    const F16 d;
    const hn::Rebind<uint32_t, F16> u;
    const auto none = hn::Set(d, std::numeric_limits<float>::infinity());
    for (uint32_t i = 0; i < count; i += static_cast<uint32_t>(hn::Lanes(d))) {
        const auto z = hn::LoadU(d, tiles.scratch.z.data() + at + i);
        float* base = tiles.base.data() + tile + i;
        const auto better = hn::And(hn::And(hn::FirstN(d, count - i), hn::Lt(z, none)), hn::Gt(z, hn::LoadU(d, base)));
        if (hn::AllFalse(d, better)) continue;
        hn::BlendedStore(z, better, d, base);
        const auto none_u = hn::Set(u, DepthTiles::kNone);
        const auto better_u = hn::RebindMask(u, better);
        const auto several = hn::Ne(hn::LoadU(u, tiles.scratch.second_plane.data() + at + i), none_u);
        const auto alone = hn::IfThenElse(several, none_u, hn::LoadU(u, tiles.scratch.plane.data() + at + i));
        hn::BlendedStore(alone, better_u, u, tiles.plane.data() + tile + i);
        for (uint64_t bits = bitsFromMask(u, hn::And(better_u, several)); bits; bits &= bits - 1) {
            const uint32_t k = i + static_cast<uint32_t>(std::countr_zero(bits));
            noteCover(tiles, tile + k, ~uint64_t{0}, planesAt(tiles.scratch, at + k));
        }
        float* layer = tiles.layer.data() + tile + i;
        const auto outdone = hn::And(better, hn::Le(hn::LoadU(d, layer), z));
        hn::BlendedStore(hn::Set(d, DepthTiles::kOpen), outdone, d, layer);
    }
}

/// Names a patch as one of those that share pixels of a tile.
HWY_INLINE void addSeam(DepthTiles& tiles, uint32_t tile, uint64_t mask, uint32_t source, float nearest) {
    uint32_t& last = tiles.seams[tile];
    if (last == DepthTiles::kNone) {
        tiles.seam_mask[tile] = tiles.tried[tile] = 0;
        tiles.paired[tile] = 0;
    }
    if (last == DepthTiles::kNone || tiles.chunks[last].count == SeamChunk::kMost) {
        const uint32_t before = last == DepthTiles::kNone ? 0 : tiles.chunks[last].before + SeamChunk::kMost;
        SeamChunk& chunk = tiles.chunks.emplace_back();
        chunk.next = last;
        chunk.before = before;
        last = static_cast<uint32_t>(tiles.chunks.size() - 1);
    }
    SeamChunk& chunk = tiles.chunks[last];
    chunk.mask[chunk.count] = mask;
    chunk.source[chunk.count] = source;
    chunk.nearest[chunk.count++] = nearest;
    tiles.lid_mask[tile] = 0;
    tiles.seam_mask[tile] |= mask;
    tiles.tried[tile] &= ~mask;
}

/// Pixels of a mask that a tile does not already claim at the nearness or nearer.
HWY_INLINE uint64_t notYetNearer(const DepthTiles& tiles, uint32_t tile, uint64_t mask, float nearness) {
    if (tiles.base[tile] >= nearness) return 0;
    if (!(tiles.layer[tile] >= nearness)) return mask;
    if (tiles.block[tile] == DepthTiles::kNone) return mask & ~tiles.layer_mask[tile];
    return mask & ~pixelsNearer(tiles.blocks.data() + 64 * size_t{tiles.block[tile]}, nearness);
}

/// Bits of pixels whose winding number is 1 or more: in a tile, and all along the row on its right as far as its right
/// border tells.
struct Wound {
    uint64_t pixels = 0, beyond = 0;
};

/// The winding numbers of one row of tiles at a tile's left border: of its eight rows of pixels, each in eight bytes.
struct RowWinding {
    alignas(64) uint8_t at[64];
};

#if HWY_TARGET == HWY_SCALAR

/// Goes through a tile: its right border becomes the next one's left.
inline Wound windPixels(RowWinding& row, const uint8_t* changes) {
    Wound out;
    for (int i = 0; i < 64; ++i) {
        row.at[i & ~7] = static_cast<uint8_t>(row.at[i & ~7] + changes[i]);
        out.pixels |= uint64_t{static_cast<int8_t>(row.at[i & ~7]) > 0} << i;
    }
    for (int i = 0; i < 64; ++i) {
        row.at[i] = row.at[i & ~7];
        out.beyond |= uint64_t{static_cast<int8_t>(row.at[i]) > 0} << i;
    }
    return out;
}

#else

/// Bits of the bytes that are greater than zero as signed numbers.
template <class Bytes, class V>
HWY_INLINE uint64_t positiveBits(Bytes, V v) {
    const hn::RebindToSigned<Bytes> d;
    const auto positive = hn::Gt(hn::BitCast(d, v), hn::Zero(d));
    if constexpr (hn::MaxLanes(Bytes()) == 64) {
        uint64_t bits;
        hn::StoreMaskBits(d, positive, reinterpret_cast<uint8_t*>(&bits));
        return bits;
    } else {
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, positive, bits);
        uint64_t part;
        std::memcpy(&part, bits, sizeof part);
        return part;
    }
}

/// Goes through a tile: its right border becomes the next one's left.
HWY_INLINE Wound windPixels(RowWinding& row, const uint8_t* changes) {
    const hn::CappedTag<uint8_t, 64> bytes;
    const hn::Repartition<uint64_t, decltype(bytes)> words;
    alignas(64) static constexpr uint8_t kLastOfEight[64] = {
        7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15, 7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15,
        7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15, 7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15};
    Wound out;
    for (size_t i = 0; i < 64; i += hn::Lanes(bytes)) {
        auto v = hn::LoadU(bytes, changes + i);
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<8>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<16>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<32>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::Load(bytes, row.at + i));
        const auto last = hn::TableLookupBytes(v, hn::Load(bytes, kLastOfEight + i));
        hn::Store(last, bytes, row.at + i);
        out.pixels |= positiveBits(bytes, v) << i;
        out.beyond |= positiveBits(bytes, last) << i;
    }
    return out;
}

#endif

/// Covers pixels of a tile, where it pays each at its own depth: where one polygon alone slopes through the tile.
HWY_INLINE void coverPart(DepthTiles& tiles, uint32_t tile, uint64_t mask, float z, const PlaneSet& planes) {
    noteCover(tiles, tile, mask, planes);
    const uint32_t plane = planes.alone();
    if (tiles.detail == Detail::kFull && plane != DepthTiles::kNone) {
        const BufferPlane& slope = tiles.planes[plane];
        if (8.0 * (std::abs(slope.dx) + std::abs(slope.dy)) > 0x1p-9 * std::abs(z))
            return coverPixelsByPlane(tiles, tile, mask, slope, tile % tiles.stride, tile / tiles.stride);
    }
    coverPixels(tiles, tile, mask, z);
}

/// Covers the tiles of a run that no open edge meets.
inline void coverBetween(Patch& patch, uint32_t row, uint32_t first, uint32_t end, uint64_t inside) {
    if (!inside || first >= end) return;
    DepthTiles& tiles = patch.tiles;
    const uint32_t tile =
        (static_cast<uint32_t>(patch.row0) + row) * tiles.stride + static_cast<uint32_t>(patch.column0);
    const size_t at = size_t{patch.pitch} * row;
    if (inside == ~uint64_t{0}) return coverRun(tiles, tile + first, at + first, end - first);
    for (uint32_t column = first; column < end; ++column)
        if (const float z = tiles.scratch.z[at + column]; z < std::numeric_limits<float>::infinity()) {
            noteCover(tiles, tile + column, inside, planesAt(tiles.scratch, at + column));
            coverPixels(tiles, tile + column, inside, z);
        }
}

/// Which of sixteen tiles have a slot.
HWY_INLINE uint32_t metByEdges(const uint32_t* slots) {
    const hn::CappedTag<uint32_t, 16> u;
    uint32_t bits = 0;
    for (size_t i = 0; i < 16; i += hn::Lanes(u))
        bits |= static_cast<uint32_t>(bitsFromMask(u, hn::Ne(hn::LoadU(u, slots + i), hn::Set(u, DepthTiles::kNone))))
                << i;
    return bits;
}

/// Carries the patch into the tiles. Returns whether it left seams.
/// @param source  as SeamEntry::source
inline bool coverPatch(Patch& patch, uint32_t source) {
    DepthTiles& tiles = patch.tiles;
    const DepthTiles::Scratch& scratch = tiles.scratch;
    bool seams = false;
    for (uint32_t row = 0; row < static_cast<uint32_t>(patch.rows); ++row) {
        const int32_t first = scratch.first[row], last = scratch.last[row];
        if (last < 0) continue;  // all of it is hidden
        RowWinding winding{};
        uint64_t inside = 0;
        uint32_t from = static_cast<uint32_t>(first);  // the first column that is not done yet
        const uint32_t tile_row = (static_cast<uint32_t>(patch.row0) + row) * tiles.stride;
        for (uint32_t group = 0; group <= static_cast<uint32_t>(last); group += 16)
            for (uint32_t left = metByEdges(scratch.slot.data() + size_t{patch.pitch} * row + group); left;
                 left &= left - 1) {
                const uint32_t column = group + static_cast<uint32_t>(std::countr_zero(left));
                coverBetween(patch, row, from, column, inside);
                from = column + 1;
                const size_t at = size_t{patch.pitch} * row + column;
                const uint32_t slot = scratch.slot[at], tile = tile_row + static_cast<uint32_t>(patch.column0) + column;
                const Wound wound = windPixels(winding, scratch.winding.data() + 64 * size_t{slot});
                inside = wound.beyond;
                if (!(tiles.base[tile] < patch.nearest)) continue;
                const uint64_t touched = scratch.touched[slot], covered = wound.pixels & ~touched;
                const float z = scratch.z[at];
                if (covered && z < std::numeric_limits<float>::infinity()) {
                    const PlaneSet planes = planesAt(scratch, at);
                    if (covered != ~uint64_t{0}) {
                        coverPart(tiles, tile, covered, z, planes);
                    } else {
                        if (planes.alone() == DepthTiles::kNone) noteCover(tiles, tile, covered, planes);
                        coverWhole(tiles, tile, z, planes.alone());
                    }
                }
                if (!touched) continue;
                if (const uint64_t seam = notYetNearer(tiles, tile, touched, patch.nearest)) {
                    addSeam(tiles, tile, seam, source, patch.nearest);
                    seams = true;
                }
            }
        coverBetween(patch, row, from, static_cast<uint32_t>(last) + 1, inside);
    }
    return seams;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
