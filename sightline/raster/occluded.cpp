// Asks the depth tiles whether they hide a rectangle: the SIMD kernel of every occlusion test.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/raster/tile_log.h"
#include "sightline/raster/seam.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/raster/occluded.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/raster/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// What a tile leaves open of a rectangle: pixels that are not surely nearer than the rectangle.
HWY_INLINE uint64_t openInTile(const DepthTiles& tiles, uint32_t tile, const PixelRect& rect, int32_t column,
                               int32_t row) {
    if (tiles.base[tile] > rect.nearness) return 0;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    return openTilePixels(tiles, tile, static_cast<uint32_t>(column), static_cast<uint32_t>(row), window,
                          rect.nearness);
}

/// Pixels that seams have not decided yet.
HWY_INLINE uint64_t undecidedPixels(const DepthTiles& tiles, uint32_t tile) {
    return tiles.seams[tile] == DepthTiles::kNone ? 0 : tiles.seam_mask[tile] & ~tiles.tried[tile];
}

/// Covers the pixels that two polygons with a shared side cover between them. A point of a pixel lies on one side or
/// the other of the shared edge; if the pixel is inside all their other sides, the point is inside that polygon.
void coverPair(DepthTiles& tiles, uint32_t tile, const SeamPolygon& a, int side_a, const SeamPolygon& b, int side_b) {
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
    if (!add(a.raster, side_a) || !add(b.raster, side_b)) return;
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
    if (covered) raiseClaims(tiles, tile, covered, depth);
}

void pairSeamsKernel(DepthTiles& tiles, uint32_t tile, uint64_t pixels) {
    constexpr int kMaxEntries = 24;  // work cap: of more, the last drawn are paired
    if (tiles.seams[tile] == DepthTiles::kNone) return;
    if (tiles.paired[tile] != tiles.seams[tile]) tiles.paired_mask[tile] = 0;
    pixels &= tiles.seam_mask[tile] & ~tiles.paired_mask[tile];
    if (!pixels) return;
    tiles.paired[tile] = tiles.seams[tile];
    tiles.paired_mask[tile] |= pixels;
    uint32_t found[kMaxEntries];
    uint64_t masks[kMaxEntries];
    int count = 0;
    const int32_t x0 = 8 * static_cast<int32_t>(tile % tiles.stride),
                  y0 = 8 * static_cast<int32_t>(tile / tiles.stride);
    for (uint32_t at = tiles.seams[tile]; at != DepthTiles::kNone && count < kMaxEntries;) {
        const SeamEntry entry = tiles.entries[at];
        at = entry.next;
        if (!(entry.mask & pixels)) continue;
        uint32_t first, polygons;
        seamPolygons(tiles, entry, first, polygons);
        for (uint32_t i = first; i < first + polygons && count < kMaxEntries; ++i) {
            SeamPolygon& polygon = tiles.polygons[i];
            const RasterPolygon& raster = polygon.raster;
            if (!raster.complete || raster.x1 < x0 || raster.x0 > x0 + 7 || raster.y1 < y0 || raster.y0 > y0 + 7)
                continue;
            setSideKeys(tiles, polygon);
            masks[count] = entry.mask & pixels;
            found[count++] = i;
        }
    }
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            int side_i, side_j;
            const SeamPolygon &a = tiles.polygons[found[i]], &b = tiles.polygons[found[j]];
            if (masks[i] & masks[j] && findSharedSide(tiles, a, b, side_i, side_j))
                coverPair(tiles, tile, a, side_i, b, side_j);
        }
}

/// Calls `look` with each tile of the rectangle that is not wholly nearer; stops when it returns false.
template <class Look>
HWY_INLINE bool forOpenTiles(DepthTiles& tiles, const PixelRect& rect, Look look) {
    const F16 d;
    const auto limit = hn::Set(d, rect.nearness);
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

bool isHiddenKernel(DepthTiles& tiles, const PixelRect& rect, Seams seams) {
    // First the cheap answer: one pixel that stays open makes the rectangle visible.
    bool undecided = false;
    const bool closed = forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        const uint64_t open = openInTile(tiles, tile, rect, column, row);
        undecided |= open != 0;
        if (seams == Seams::kLeave) return !open;
        return !(open & ~undecidedPixels(tiles, tile));
    });
    if (!closed || !undecided) return closed;
    return forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        pairSeamsKernel(tiles, tile, openInTile(tiles, tile, rect, column, row));
        for (uint64_t open = openInTile(tiles, tile, rect, column, row); open; open &= open - 1) {
            const int bit = std::countr_zero(open);
            resolveSeam(tiles, tile, bit, rect.nearness);
            if (openInTile(tiles, tile, rect, column, row) & uint64_t{1} << bit) return false;
        }
        return true;
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

uint64_t openPixelsKernel(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64], Seams seams) {
    const uint64_t open = openAgainst(tiles, tile, window, nearest);
    const uint64_t undecided = open & undecidedPixels(tiles, tile);
    if (seams == Seams::kLeave || !undecided) return open;
    pairSeamsKernel(tiles, tile, undecided);
    for (uint64_t set = openAgainst(tiles, tile, undecided, nearest); set; set &= set - 1) {
        const int bit = std::countr_zero(set);
        resolveSeam(tiles, tile, bit, nearest[bit]);
    }
    return openAgainst(tiles, tile, window, nearest);
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
HWY_EXPORT(pairSeamsKernel);
HWY_EXPORT(readClaimsKernel);
HWY_EXPORT(raiseClaimsKernel);

bool isHidden(DepthTiles& tiles, const PixelRect& rect, Seams seams) {
    const bool hidden = HWY_DYNAMIC_DISPATCH(isHiddenKernel)(tiles, rect, seams);
    if (tiles.log) tiles.log->note(rect, seams, hidden);
    return hidden;
}

uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64], Seams seams) {
    const uint64_t open = HWY_DYNAMIC_DISPATCH(openPixelsKernel)(tiles, tile, window, nearest, seams);
    if (tiles.log) tiles.log->note(tile, window, nearest, seams, open);
    return open;
}

uint64_t undecidedSeams(const DepthTiles& tiles, uint32_t tile) {
    return tiles.seams[tile] == DepthTiles::kNone ? 0 : tiles.seam_mask[tile] & ~tiles.tried[tile];
}

void pairSeams(DepthTiles& tiles, uint32_t tile, uint64_t pixels) {
    HWY_DYNAMIC_DISPATCH(pairSeamsKernel)(tiles, tile, pixels);
}

void readClaims(const DepthTiles& tiles, uint32_t tile, float (&claims)[64]) {
    HWY_DYNAMIC_DISPATCH(readClaimsKernel)(tiles, tile, claims);
}

void raiseClaims(DepthTiles& tiles, uint32_t tile, uint64_t mask, const float (&depths)[64]) {
    HWY_DYNAMIC_DISPATCH(raiseClaimsKernel)(tiles, tile, mask, depths);
}

}  // namespace sightline
#endif  // HWY_ONCE
