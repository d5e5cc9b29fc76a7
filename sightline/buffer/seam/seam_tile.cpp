// What the seams of a tile have in common for all its pixels: which polygons are near, and what masks alone can tell.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/ablate.h"
#include "sightline/base/assert.h"
#include "sightline/buffer/covers.h"
#include "sightline/buffer/seam/seam.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/seam/seam_tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

uint64_t polygonsInKernel(const float* boxes, uint32_t count, const SeamRect& rect) {
    const F16 d;
    const auto least = hn::Set(d, rect.least);
    const auto x0 = hn::Set(d, rect.x0), y0 = hn::Set(d, rect.y0), x1 = hn::Set(d, rect.x1), y1 = hn::Set(d, rect.y1);
    uint64_t in = 0;
    for (uint32_t first = 0; first < count; first += 16) {
        const float* box = boxes + 4 * size_t{first};
        for (size_t h = 0; h < 16; h += hn::Lanes(d)) {
            const auto left = hn::LoadU(d, box + h), low = hn::LoadU(d, box + 16 + h);
            const auto right = hn::LoadU(d, box + 32 + h), high = hn::LoadU(d, box + 48 + h);
            const auto across = hn::And(hn::Le(left, x1), hn::Ge(right, x0));
            const auto along = hn::And(hn::Le(low, y1), hn::Ge(high, y0));
            const auto large = hn::Ge(hn::Min(hn::Sub(right, left), hn::Sub(high, low)), least);
            in |= bitsFromMask(d, hn::And(large, hn::And(across, along))) << (first + h);
        }
    }
    return in;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(polygonsInKernel);

uint64_t polygonsIn(const float* boxes, uint32_t count, const SeamRect& rect) {
    SIGHTLINE_DEBUG_ASSERT(count > 0 && count <= 64);
    return HWY_DYNAMIC_DISPATCH(polygonsInKernel)(boxes, count, rect);
}

/// A corner of a pixel is covered by an entry only if the entry touches, or something covers, all four pixels that meet
/// there; of those that lie in the next tile nothing is known. One polygon alone covers what it covers when it is drawn,
/// and no more, but where gaps are closed: it is drawn a little smaller there.
SeamMasks lookAtSeams(DepthTiles& tiles, uint32_t tile, uint64_t pixels, float wanted) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.seams.size());
    if (detail::kAblate.masks) return {0, ~uint64_t{0}};
    constexpr uint64_t kFirst = 0x0101010101010101ull, kLast = kFirst << 7, kLow = 0xff, kHigh = kLow << 56;
    const uint64_t covered = tiles.coveredBits(tile);
    uint64_t once = 0, twice = 0, more = 0, corners[4] = {};
    forSeamEntries(tiles, tile, [&](const SeamEntry& entry) {
        const uint64_t mask = entry.mask;
        if (!(entry.nearest > wanted)) return;
        const bool patch = entry.polygon() == SeamEntry::kAllPolygons;
        more |= (patch ? once : twice) & mask;
        twice |= (patch ? mask : once) & mask;
        once |= mask;
        const uint64_t touched = mask | covered;
        const uint64_t left = touched & (touched << 1 | kFirst), right = touched & (touched >> 1 | kLast);
        corners[0] |= mask & left & (left << 8 | kLow);
        corners[1] |= mask & left & (left >> 8 | kHigh);
        corners[2] |= mask & right & (right << 8 | kLow);
        corners[3] |= mask & right & (right >> 8 | kHigh);
    });
    tiles.lid[tile] = wanted;
    if (tiles.gap > 0) twice = once;
    tiles.lid_mask[tile] = ~(twice & corners[0] & corners[1] & corners[2] & corners[3]);
    return {pixels & tiles.lid_mask[tile], ~more};
}

}  // namespace sightline
#endif  // HWY_ONCE
