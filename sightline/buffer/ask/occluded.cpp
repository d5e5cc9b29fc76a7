// Asks the depth tiles whether they hide a rectangle: the SIMD kernel of every occlusion test.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/covers.h"
#include "sightline/buffer/seam/seam.h"
#include "sightline/buffer/tile_log.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/ask/occluded.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// What a tile leaves open of a rectangle: pixels that are not surely nearer than the rectangle.
HWY_INLINE uint64_t openInTile(const DepthTiles& tiles, uint32_t tile, const PixelRect& rect, int32_t column,
                               int32_t row) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && column >= 0 && row >= 0);
    if (tiles.base[tile] > rect.nearness) return 0;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    return openTilePixels(tiles, tile, static_cast<uint32_t>(column), static_cast<uint32_t>(row), window,
                          rect.nearness);
}

/// Pixels that seams have not decided yet for what lies at a nearness, if they are open to it now.
HWY_INLINE uint64_t undecidedPixels(const DepthTiles& tiles, uint32_t tile, float nearness) {
    if (tiles.seams[tile] == DepthTiles::kNone) return 0;
    const uint64_t seams = tiles.seam_mask[tile] & ~tiles.tried[tile];
    return tiles.lid[tile] <= nearness ? seams & ~tiles.lid_mask[tile] : seams;
}

/// Calls `look` with each tile of the rectangle that is not wholly nearer; stops when it returns false.
template <class Look>
HWY_INLINE bool forOpenTiles(DepthTiles& tiles, const PixelRect& rect, Look look) {
    const F16 d;
    const auto limit = hn::Set(d, rect.nearness);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.x0 && rect.x0 <= rect.x1 && static_cast<uint32_t>(rect.x1) < tiles.width);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.y0 && rect.y0 <= rect.y1 && static_cast<uint32_t>(rect.y1) < tiles.height);
    const int32_t first = rect.x0 >> 3, last = rect.x1 >> 3;
    for (int32_t row = rect.y0 >> 3; row <= rect.y1 >> 3; ++row) {
        const float* base = tiles.base.data() + static_cast<size_t>(row) * tiles.stride;
        for (int32_t chunk = first & ~15; chunk <= last; chunk += 16) {
            uint32_t open = 0xffffu << std::max(0, first - chunk) & 0xffffu >> std::max(0, chunk + 15 - last);
            for (size_t h = 0; h < 16; h += hn::Lanes(d))
                open &= ~static_cast<uint32_t>(bitsFromMask(d, hn::Gt(hn::LoadU(d, base + chunk + h), limit)) << h);
            for (; open; open &= open - 1) {
                const int32_t column = chunk + std::countr_zero(open);
                if (!look(static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column), column, row))
                    return false;
            }
        }
    }
    return true;
}

/// Tiles in which seams decide, as far as they fit.
struct Undecided {
    static constexpr int kMost = 64;
    uint32_t tile[kMost];
    uint64_t open[kMost];
    int count = 0;

    HWY_INLINE void add(uint32_t which, uint64_t pixels) {
        SIGHTLINE_DEBUG_ASSERT(pixels != 0);
        if (count < kMost) {
            tile[count] = which;
            open[count] = pixels;
        }
        ++count;
    }
};

/// Whether seams close the pixels of a tile that are open to what lies at a nearness.
bool closeSeams(DepthTiles& tiles, uint32_t tile, uint64_t open, float nearness, const OccludeeBox* box) {
    SIGHTLINE_DEBUG_ASSERT(open != 0);
    alignas(64) float claims[64];
    claimsOfTile(tiles, tile, claims);
    open &= ~pixelsNearer(claims, nearness);
    if (open && box) open = openToBox(tiles, tile, open, *box);
    if (!open) return true;
    // Those first that few polygons share: they are the cheapest, and the likeliest to stay open.
    const uint64_t few = lookAtSeams(tiles, tile, open, nearness).few;
    for (uint64_t part : {open & few, open & ~few})
        for (; part; part &= part - 1)
            if (!resolveSeam(tiles, tile, std::countr_zero(part), nearness) &&
                (!box || openToBox(tiles, tile, part & -part, *box)))
                return false;
    return true;
}

/// What is left open of a rectangle in a tile where depths leave some open, if planes are asked, too.
/// @param sure  set if a pixel stays open whatever the seams are, else cleared
HWY_INLINE uint64_t leaveOpen(DepthTiles& tiles, uint32_t tile, uint64_t open, const PixelRect& rect, Seams seams,
                              const OccludeeBox* box, bool& sure) {
    SIGHTLINE_DEBUG_ASSERT(open != 0);
    const uint64_t undecided = seams == Seams::kLeave ? 0 : undecidedPixels(tiles, tile, rect.nearness);
    sure = (open & ~undecided) != 0;
    if (!box || (open & ~undecided & ~coveredByPlanes(tiles, tile))) return open;
    open = openToBox(tiles, tile, open, *box);
    sure = (open & ~undecided) != 0;
    return open;
}

bool isHiddenKernel(DepthTiles& tiles, const PixelRect& rect, Seams seams, const OccludeeBox* box) {
    // First the cheap answer: one pixel that stays open makes the rectangle visible.
    Undecided undecided;
    const bool closed = forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        if (box && isBehindBase(tiles, tile, *box)) return true;  // before a look at its pixels
        uint64_t open = openInTile(tiles, tile, rect, column, row);
        if (!open) return true;
        bool surely_open;
        open = leaveOpen(tiles, tile, open, rect, seams, box, surely_open);
        if (surely_open) return false;
        if (open) undecided.add(tile, open);
        return true;
    });
    if (!closed || !undecided.count) return closed;
    const int listed = std::min(undecided.count, Undecided::kMost);
    // Then what the masks of the seams tell; then pixel by pixel.
    for (int i = 0; i < listed; ++i)
        if (lookAtSeams(tiles, undecided.tile[i], undecided.open[i], rect.nearness).open) return false;
    for (int i = 0; i < listed; ++i)
        if (!closeSeams(tiles, undecided.tile[i], undecided.open[i], rect.nearness, box)) return false;
    if (listed == undecided.count) return true;
    return forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        const uint64_t open = openInTile(tiles, tile, rect, column, row);
        return !open || closeSeams(tiles, tile, open, rect.nearness, box);
    });
}

HWY_INLINE uint64_t openAgainst(const DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64]) {
    const F16 d;
    alignas(64) float claims[64];
    claimsOfTile(tiles, tile, claims);
    uint64_t nearer = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        nearer |= bitsFromMask(d, hn::Gt(hn::Load(d, claims + i), hn::LoadU(d, nearest + i))) << i;
    return window & ~nearer;
}

uint64_t openPixelsKernel(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64], Seams seams,
                          const OccludeeBox* box) {
    const auto behind = [&](uint64_t open) { return open && box ? openToBox(tiles, tile, open, *box) : open; };
    const uint64_t open = behind(openAgainst(tiles, tile, window, nearest));
    const uint64_t undecided = open & undecidedSeams(tiles, tile);
    if (seams == Seams::kLeave || !undecided) return open;
    for (uint64_t set = openAgainst(tiles, tile, undecided, nearest); set; set &= set - 1) {
        const int bit = std::countr_zero(set);
        resolveSeam(tiles, tile, bit, nearest[bit]);
    }
    return behind(openAgainst(tiles, tile, open, nearest));
}

void readClaimsKernel(const DepthTiles& tiles, uint32_t tile, float (&claims)[64]) {
    claimsOfTile(tiles, tile, claims);
}

void raiseClaimsKernel(DepthTiles& tiles, uint32_t tile, uint64_t mask, const float (&depths)[64]) {
    raiseBlockBy(tiles, tile, mask, depths);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(isHiddenKernel);
HWY_EXPORT(openPixelsKernel);
HWY_EXPORT(readClaimsKernel);
HWY_EXPORT(raiseClaimsKernel);

bool isHidden(DepthTiles& tiles, const PixelRect& rect, Seams seams, const OccludeeBox* box) {
    SIGHTLINE_DEBUG_ASSERT(tiles.width > 0 && tiles.height > 0);
    const bool hidden = HWY_DYNAMIC_DISPATCH(isHiddenKernel)(tiles, rect, seams, box);
    if (tiles.log) tiles.log->note(rect, seams, box, hidden);
    return hidden;
}

uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64], Seams seams,
                    const OccludeeBox* box) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.stride * tiles.rows);
    const uint64_t open = HWY_DYNAMIC_DISPATCH(openPixelsKernel)(tiles, tile, window, nearest, seams, box);
    if (tiles.log) tiles.log->note(tile, window, nearest, seams, box, open);
    return open;
}

uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, float nearest, Seams seams,
                    const OccludeeBox* box) {
    if (tiles.base[tile] > nearest && !tiles.log) return 0;
    float all[64];
    std::fill_n(all, 64, nearest);
    return openPixels(tiles, tile, window, all, seams, box);
}

uint64_t undecidedSeams(const DepthTiles& tiles, uint32_t tile) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.seams.size());
    return tiles.seams[tile] == DepthTiles::kNone ? 0 : tiles.seam_mask[tile] & ~tiles.tried[tile];
}

void readClaims(const DepthTiles& tiles, uint32_t tile, float (&claims)[64]) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size());
    HWY_DYNAMIC_DISPATCH(readClaimsKernel)(tiles, tile, claims);
}

void raiseClaims(DepthTiles& tiles, uint32_t tile, uint64_t mask, const float (&depths)[64]) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && mask != 0);
    HWY_DYNAMIC_DISPATCH(raiseClaimsKernel)(tiles, tile, mask, depths);
}

}  // namespace sightline
#endif  // HWY_ONCE
