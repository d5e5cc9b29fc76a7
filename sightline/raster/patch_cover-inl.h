// Carries a patch from its scratch into the tiles: which pixels it covers, and which its open edges leave in doubt.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_RASTER_PATCH_COVER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RASTER_PATCH_COVER_INL_H
#undef SIGHTLINE_RASTER_PATCH_COVER_INL_H
#else
#define SIGHTLINE_RASTER_PATCH_COVER_INL_H
#endif

#include "sightline/raster/patch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

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
        hn::BlendedStore(hn::LoadU(u, tiles.scratch.plane.data() + at + i), hn::RebindMask(u, better), u,
                         tiles.plane.data() + tile + i);
        float* layer = tiles.layer.data() + tile + i;
        const auto outdone = hn::And(better, hn::Le(hn::LoadU(d, layer), z));
        hn::BlendedStore(hn::Set(d, DepthTiles::kOpen), outdone, d, layer);
    }
}

/// Names a patch as one of those that share pixels of a tile.
HWY_INLINE void addSeam(DepthTiles& tiles, uint32_t tile, uint64_t mask, uint32_t source) {
    if (tiles.seams[tile] == DepthTiles::kNone) {
        tiles.seam_mask[tile] = tiles.tried[tile] = tiles.paired_mask[tile] = 0;
        tiles.paired[tile] = DepthTiles::kNone;
    }
    tiles.entries.push_back({mask, source, tiles.seams[tile]});
    tiles.seams[tile] = static_cast<uint32_t>(tiles.entries.size() - 1);
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

/// The winding numbers of one row of tiles at a tile's left border: of its eight rows of pixels, each in eight bytes.
struct RowWinding {
    alignas(64) uint8_t at[64];
};

#if HWY_TARGET == HWY_SCALAR

/// Bits of the pixels whose winding number is 1 or more; the tile's right border becomes the next one's left.
inline uint64_t windPixels(RowWinding& row, const uint8_t* changes) {
    uint64_t inside = 0;
    for (int i = 0; i < 64; ++i) {
        row.at[i & ~7] = static_cast<uint8_t>(row.at[i & ~7] + changes[i]);
        inside |= uint64_t{static_cast<int8_t>(row.at[i & ~7]) > 0} << i;
    }
    for (int i = 0; i < 64; ++i) row.at[i] = row.at[i & ~7];
    return inside;
}

#else

/// Bits of the bytes that are greater than zero as signed numbers, of 64.
template <class Bytes, class V>
HWY_INLINE uint64_t positiveBits(Bytes, V v, size_t i) {
    const hn::RebindToSigned<Bytes> d;
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Gt(hn::BitCast(d, v), hn::Zero(d)), bits);
    uint64_t part;
    std::memcpy(&part, bits, sizeof part);
    return part << i;
}

/// Bits of the pixels whose winding number is 1 or more; the tile's right border becomes the next one's left.
HWY_INLINE uint64_t windPixels(RowWinding& row, const uint8_t* changes) {
    const hn::CappedTag<uint8_t, 64> bytes;
    const hn::Repartition<uint64_t, decltype(bytes)> words;
    alignas(64) static constexpr uint8_t kLastOfEight[64] = {
        7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15, 7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15,
        7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15, 7, 7, 7, 7, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15};
    uint64_t inside = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(bytes)) {
        auto v = hn::LoadU(bytes, changes + i);
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<8>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<16>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::BitCast(bytes, hn::ShiftLeft<32>(hn::BitCast(words, v))));
        v = hn::Add(v, hn::Load(bytes, row.at + i));
        hn::Store(hn::TableLookupBytes(v, hn::Load(bytes, kLastOfEight + i)), bytes, row.at + i);
        inside |= positiveBits(bytes, v, i);
    }
    return inside;
}

#endif

/// Bits of the pixels that are inside all along a row of tiles, as far as the winding at its left border tells.
HWY_INLINE uint64_t insideOf(const RowWinding& row) {
    uint64_t inside = 0;
    for (int k = 0; k < 8; ++k)
        if (static_cast<int8_t>(row.at[8 * k]) > 0) inside |= uint64_t{0xff} << (8 * k);
    return inside;
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
        if (const float z = tiles.scratch.z[at + column]; z < std::numeric_limits<float>::infinity())
            coverPixels(tiles, tile + column, inside, z);
}

/// Carries the patch into the tiles. Returns whether it left seams.
/// @param source  as SeamEntry::source
inline bool coverPatch(Patch& patch, uint32_t source) {
    DepthTiles& tiles = patch.tiles;
    const DepthTiles::Scratch& scratch = tiles.scratch;
    bool seams = false;
    for (uint32_t row = 0; row < static_cast<uint32_t>(patch.rows); ++row) {
        RowWinding winding{};
        uint64_t inside = 0;
        uint32_t from = 0;  // the first column that is not done yet
        const uint32_t tile_row = (static_cast<uint32_t>(patch.row0) + row) * tiles.stride;
        for (uint32_t word = 0; word < patch.words; ++word)
            for (uint64_t left = scratch.marked[row * patch.words + word]; left; left &= left - 1) {
                const uint32_t column = 64 * word + static_cast<uint32_t>(std::countr_zero(left));
                coverBetween(patch, row, from, column, inside);
                from = column + 1;
                const size_t at = size_t{patch.pitch} * row + column;
                const uint32_t slot = scratch.slot[at], tile = tile_row + static_cast<uint32_t>(patch.column0) + column;
                const uint64_t pixels = windPixels(winding, scratch.winding.data() + 64 * size_t{slot});
                inside = insideOf(winding);
                const uint64_t touched = scratch.touched[slot], covered = pixels & ~touched;
                const float z = scratch.z[at];
                if (covered && z < std::numeric_limits<float>::infinity()) {
                    if (covered == ~uint64_t{0}) coverWhole(tiles, tile, z, scratch.plane[at]);
                    else coverPixels(tiles, tile, covered, z);
                }
                if (!touched) continue;
                if (const uint64_t seam = notYetNearer(tiles, tile, touched, patch.nearest)) {
                    addSeam(tiles, tile, seam, source);
                    seams = true;
                }
            }
        coverBetween(patch, row, from, static_cast<uint32_t>(patch.columns), inside);
    }
    return seams;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
