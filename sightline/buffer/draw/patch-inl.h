// A patch: polygons of one winding that are covered together; the tiles that they may meet, and the scratch for those.
// SPDX-License-Identifier: MIT
//
// The argument. Let F be a set of polygons, w(p) the number of those with counter-clockwise images that hold the image
// point p less the clockwise ones. Crossing an edge changes w unless another polygon of F has the same edge the other way
// round: all but the open edges cancel. So w is the same all over a pixel that no open edge touches; and if it is 1 or
// more at its centre, each ray through the pixel meets a front face of F, no farther than the farthest point of F there.
// w is a sum over the open edges that cross the row to the left of the centre. Rounding moves a vertex for all edges that
// meet there at once; w at a point changes only where an open edge passes over it, and the pixels within reach of
// that count as touched. So neither which way a sliver winds nor a rounded position can cover too much.
#if defined(SIGHTLINE_BUFFER_DRAW_PATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_PATCH_INL_H
#undef SIGHTLINE_BUFFER_DRAW_PATCH_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_PATCH_INL_H
#endif

#include <bit>

#include "sightline/buffer/tile_ops-inl.h"

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
    uint32_t pitch = 0;      ///< tiles from one row of the scratch to the next, a multiple of 16
    uint32_t slots = 0;      ///< in use
    size_t first_plane = 0;  ///< of its own, in DepthTiles::planes
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
    patch.first_plane = tiles.planes.size();
    const double near = extent.nearest + std::abs(extent.nearest) * 0x1p-22 + patch.depth_error;
    patch.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    DepthTiles::Scratch& scratch = tiles.scratch;
    const size_t count = size_t{patch.pitch} * static_cast<size_t>(patch.rows);
    if (scratch.slot.size() < count + DepthTiles::kBeyond) {
        scratch.z.resize(count + DepthTiles::kBeyond);
        scratch.plane.resize(count + DepthTiles::kBeyond);
        scratch.second_plane.resize(count + DepthTiles::kBeyond);
        scratch.slot.resize(count + DepthTiles::kBeyond);
    }
    if (scratch.first.size() < static_cast<size_t>(patch.rows)) {
        scratch.first.resize(static_cast<size_t>(patch.rows));
        scratch.last.resize(static_cast<size_t>(patch.rows));
    }
    if (!openColumns(patch)) return false;
    std::fill_n(scratch.z.data(), count, std::numeric_limits<float>::infinity());
    std::fill_n(scratch.plane.data(), count, DepthTiles::kNone);
    std::fill_n(scratch.second_plane.data(), count, DepthTiles::kNone);
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

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
