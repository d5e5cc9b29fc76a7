// What the seams of a tile have in common for all its pixels: pairs that share a side, and what masks alone can tell.
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

/// Covers the pixels that two polygons with a shared side cover between them. A point of a pixel lies on one side or
/// the other of the shared edge; if the pixel is inside all their other sides, the point is inside that polygon.
/// @param pixels  those that matter; nothing is done about others, so that it does not matter when this is done
/// @returns  the pixels that it has covered
uint64_t coverPair(DepthTiles& tiles, uint32_t tile, uint64_t pixels, const SeamPolygon& a, int side_a,
                   const SeamPolygon& b, int side_b) {
    SIGHTLINE_DEBUG_ASSERT(pixels != 0 && tile < tiles.base.size());
    SIGHTLINE_DEBUG_ASSERT(side_a >= 0 && side_a < a.raster.edges && side_b >= 0 && side_b < b.raster.edges);
    const double x = 8.0 * (tile % tiles.stride) + 4.0, y = 8.0 * (tile / tiles.stride) + 4.0;
    struct Line {
        float a, b, c;
    };
    Line lines[6];
    int count = 0;
    const auto add = [&](const RasterPolygon& p, int without) {
        for (int e = 0; e < p.edges; ++e) {
            if (e == without) continue;
            const float c = static_cast<float>(p.edge[e].at(x, y));
            if (c < -4.0f) return false;
            if (c < 4.0f + p.slack)
                lines[count++] = {static_cast<float>(p.edge[e].a), static_cast<float>(p.edge[e].b), c};
        }
        return true;
    };
    if (!add(a.raster, side_a) || !add(b.raster, side_b)) return 0;
    SIGHTLINE_DEBUG_ASSERT(count <= 6);
    TilePlane planes[2];
    for (int i = 0; i < 2; ++i) {
        const RasterPolygon& p = i ? b.raster : a.raster;
        planes[i] = {p.farthest, 0, 0, p.farthest};
        if (!p.planar) continue;
        const double tilt = std::abs(p.dx) + std::abs(p.dy), z = p.d0 + p.dx * x + p.dy * y;
        const double error = p.depth_error + 0x1p-21 * (std::abs(z) + 4.0 * tilt);
        planes[i] = {static_cast<float>(z - 0.5 * tilt - error), static_cast<float>(p.dx), static_cast<float>(p.dy),
                     p.farthest};
    }
    alignas(64) float depth[64];
    const F8 half;
    const auto limit = hn::Set(half, 0.5f + std::max(a.raster.slack, b.raster.slack));
    const auto offset = hn::Iota(half, -3.5f);
    uint64_t covered = 0;
    for (int row = 0; row < 8; ++row) {
        const float dy = static_cast<float>(row) - 3.5f;
        for (size_t h = 0; h < 8; h += hn::Lanes(half)) {
            const auto dx = hn::Add(offset, hn::Set(half, static_cast<float>(h)));
            auto least = hn::Set(half, 1e30f);
            for (int l = 0; l < count; ++l)
                least = hn::Min(least, hn::Add(hn::Set(half, lines[l].c + lines[l].b * dy),
                                               hn::Mul(hn::Set(half, lines[l].a), dx)));
            const auto z = hn::Min(planeDepth(half, planes[0], row, dx), planeDepth(half, planes[1], row, dx));
            hn::Store(z, half, depth + 8 * row + h);
            covered |= bitsFromMask(half, hn::Ge(least, limit)) << (8 * row + static_cast<int>(h));
        }
    }
    covered &= pixels;
    if (covered) raiseClaims(tiles, tile, covered, depth);
    return covered;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(polygonsInKernel);
HWY_EXPORT(coverPair);

uint64_t polygonsIn(const float* boxes, uint32_t count, const SeamRect& rect) {
    SIGHTLINE_DEBUG_ASSERT(count > 0 && count <= 64);
    return HWY_DYNAMIC_DISPATCH(polygonsInKernel)(boxes, count, rect);
}

void pairSeams(DepthTiles& tiles, uint32_t tile) {
    constexpr int kMost = 96;       // work cap: of more polygons the last drawn are paired
    constexpr float kLeast = 0.5f;  // [pixels]: what smaller ones may cover between them is left to resolveSeam()
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.seams.size());
    if (detail::kAblate.seams || detail::kAblate.pairs || tiles.seams[tile] == DepthTiles::kNone) return;
    const SeamChunk& last = tiles.chunks[tiles.seams[tile]];
    const uint32_t all = last.before + last.count, known = tiles.paired[tile];
    SIGHTLINE_DEBUG_ASSERT(known <= all);
    if (known == all) return;
    tiles.paired[tile] = all;
    uint32_t found[kMost], left_over = all;
    uint64_t masks[kMost], bits[kMost];
    int count = 0, fresh = -1;
    const int32_t x0 = 8 * static_cast<int32_t>(tile % tiles.stride),
                  y0 = 8 * static_cast<int32_t>(tile / tiles.stride);
    const float left = static_cast<float>(x0), bottom = static_cast<float>(y0);
    forSeamEntries(tiles, tile, [&](const SeamEntry& entry) {
        if (left_over-- == known) fresh = count;  // from here on they were paired with each other
        if (entry.polygon() != SeamEntry::kAllPolygons || count == kMost) return;
        forSeamPolygons(tiles, entry, {left, bottom, left + 8.0f, bottom + 8.0f, kLeast}, [&](uint32_t i) {
            const RasterPolygon& raster = tiles.polygons[i].raster;
            if (count == kMost || !raster.complete || raster.x1 < x0 || raster.x0 > x0 + 7 || raster.y1 < y0 ||
                raster.y0 > y0 + 7)
                return;
            masks[count] = entry.mask;
            bits[count] = tiles.polygons[i].edge_bits;
            found[count++] = i;
        });
    });
    if (fresh < 0) fresh = count;
    SIGHTLINE_DEBUG_ASSERT(fresh <= count && count <= kMost);
    for (int i = 0; i < fresh; ++i)
        for (int j = i + 1; j < count; ++j) {
            if (!(masks[i] & masks[j]) || !(bits[i] & bits[j])) continue;
            const SeamPolygon &a = tiles.polygons[found[i]], &b = tiles.polygons[found[j]];
            int side_a, side_b;
            if (!findSharedSide(tiles, a, b, side_a, side_b)) continue;
            // Where the side does not meet the tile, one of them is alone there.
            if (std::abs(a.raster.edge[side_a].at(left + 4.0, bottom + 4.0)) > 4.0 + a.raster.slack) continue;
            const uint64_t covered =
                HWY_DYNAMIC_DISPATCH(coverPair)(tiles, tile, masks[i] & masks[j], a, side_a, b, side_b);
            if (covered && !(tiles.gap > 0))
                noteCover(tiles, tile, covered, PlaneSet(seamPlane(tiles, found[i]), seamPlane(tiles, found[j])));
        }
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
