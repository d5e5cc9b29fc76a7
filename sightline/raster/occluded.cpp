// Asks the depth tiles whether they hide a rectangle: the SIMD kernel of every occlusion test.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/raster/tile_log.h"
#include "sightline/raster/tiles.h"

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
uint64_t openInTile(DepthTiles& tiles, uint32_t tile, const PixelRect& rect, int32_t column, int32_t row) {
    if (tiles.farthest[tile] > rect.nearness) return 0;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    if (tiles.form[tile] == DepthTiles::Form::kEmpty) return window;
    toPixels(tiles, tile);
    return window & pixelsNotNearer(tiles.depth.data() + 64 * size_t{tile}, rect.nearness);
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
    toPixels(tiles, tile);
    float* depth = tiles.depth.data() + 64 * size_t{tile};
    const F8 half;
    const auto limit = hn::Set(half, 0.5f + std::max(a.raster.slack, b.raster.slack));
    const auto offset = hn::Iota(half, -3.5f);
    auto least_depth = hn::Set(half, std::numeric_limits<float>::infinity());
    for (int row = 0; row < 8; ++row) {
        const float dy = static_cast<float>(row) - 3.5f;
        for (size_t h = 0; h < 8; h += hn::Lanes(half)) {
            const auto dx = hn::Add(offset, hn::Set(half, static_cast<float>(h)));
            auto least = hn::Set(half, 1e30f);
            for (int l = 0; l < count; ++l)
                least = hn::Min(least, hn::Add(hn::Set(half, lines[l].c + lines[l].b * dy),
                                               hn::Mul(hn::Set(half, lines[l].a), dx)));
            const auto mask = hn::Ge(least, limit);
            float* place = depth + 8 * row + h;
            const auto old = hn::LoadU(half, place);
            const auto z = hn::Min(planeDepth(half, planes[0], row, dx), planeDepth(half, planes[1], row, dx));
            const auto raised = hn::IfThenElse(mask, hn::Max(old, z), old);
            hn::StoreU(raised, half, place);
            least_depth = hn::Min(least_depth, raised);
            tiles.covered[tile] |= bitsFromMask(half, mask) << (8 * row + static_cast<int>(h));
        }
    }
    if (tiles.covered[tile] == ~uint64_t{0}) tiles.farthest[tile] = hn::GetLane(hn::MinOfLanes(half, least_depth));
}

void pairSeamsKernel(DepthTiles& tiles, uint32_t tile, uint64_t pixels) {
    constexpr int kMaxEntries = 24;  // work cap: of more, the last drawn are paired
    if (tiles.paired[tile] != tiles.seams[tile]) tiles.paired_mask[tile] = 0;
    pixels &= tiles.seam_mask[tile] & ~tiles.paired_mask[tile];
    if (!pixels) return;
    tiles.paired[tile] = tiles.seams[tile];
    tiles.paired_mask[tile] |= pixels;
    const SeamPolygon* found[kMaxEntries];
    uint64_t masks[kMaxEntries];
    int count = 0;
    for (uint32_t at = tiles.seams[tile]; at != DepthTiles::kNone && count < kMaxEntries; at = tiles.entries[at].next) {
        const uint64_t mask = tiles.entries[at].mask & pixels;
        SeamPolygon& polygon = tiles.polygons[tiles.entries[at].polygon];
        if (!mask || !polygon.raster.complete) continue;
        setSideKeys(tiles, polygon);
        masks[count] = mask;
        found[count++] = &polygon;
    }
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            int side_i, side_j;
            if (masks[i] & masks[j] && findSharedSide(tiles, *found[i], *found[j], side_i, side_j))
                coverPair(tiles, tile, *found[i], side_i, *found[j], side_j);
        }
}

/// Calls `look` with each tile of the rectangle that is not wholly nearer; stops when it returns false.
template <class Look>
HWY_INLINE bool forOpenTiles(DepthTiles& tiles, const PixelRect& rect, Look look) {
    const F8 d;
    const auto limit = hn::Set(d, rect.nearness);
    const int32_t first = rect.x0 >> 3, last = rect.x1 >> 3;
    for (int32_t row = rect.y0 >> 3; row <= rect.y1 >> 3; ++row) {
        const float* farthest = tiles.farthest.data() + static_cast<size_t>(row) * tiles.stride;
        for (int32_t chunk = first & ~7; chunk <= last; chunk += 8) {
            uint32_t open = 0xffu << std::max(0, first - chunk) & 0xffu >> std::max(0, chunk + 7 - last);
            for (size_t h = 0; h < 8; h += hn::Lanes(d))
                open &= ~static_cast<uint32_t>(bitsFromMask(d, hn::Gt(hn::LoadU(d, farthest + chunk + h), limit)) << h);
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
        return !(open & (~tiles.seam_mask[tile] | tiles.tried[tile]));
    });
    if (!closed || !undecided) return closed;
    return forOpenTiles(tiles, rect, [&](uint32_t tile, int32_t column, int32_t row) HWY_ATTR {
        pairSeamsKernel(tiles, tile, openInTile(tiles, tile, rect, column, row));
        for (uint64_t open = openInTile(tiles, tile, rect, column, row); open; open &= open - 1) {
            const int bit = std::countr_zero(open);
            if (!resolveSeam(tiles, tile, bit, rect.nearness)) return false;
            if (!(tiles.depth[64 * size_t{tile} + static_cast<size_t>(bit)] > rect.nearness)) return false;
        }
        return true;
    });
}

uint64_t openAgainst(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64]) {
    if (tiles.form[tile] == DepthTiles::Form::kEmpty) return window;
    toPixels(tiles, tile);
    const F16 d;
    const float* depth = tiles.depth.data() + 64 * size_t{tile};
    uint64_t nearer = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(d))
        nearer |= bitsFromMask(d, hn::Gt(hn::LoadU(d, depth + i), hn::LoadU(d, nearest + i))) << i;
    return window & ~nearer;
}

uint64_t openPixelsKernel(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64], Seams seams) {
    uint64_t open = openAgainst(tiles, tile, window, nearest);
    const uint64_t undecided = open & tiles.seam_mask[tile];
    if (seams == Seams::kLeave || !undecided) return open;
    pairSeamsKernel(tiles, tile, undecided);
    for (uint64_t set = openAgainst(tiles, tile, undecided, nearest); set; set &= set - 1) {
        const int bit = std::countr_zero(set);
        resolveSeam(tiles, tile, bit, nearest[bit]);
    }
    return openAgainst(tiles, tile, window, nearest);
}

void writeOutKernel(DepthTiles& tiles, uint32_t tile) { toPixels(tiles, tile); }

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(isHiddenKernel);
HWY_EXPORT(openPixelsKernel);
HWY_EXPORT(pairSeamsKernel);
HWY_EXPORT(writeOutKernel);

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

void pairSeams(DepthTiles& tiles, uint32_t tile, uint64_t pixels) {
    HWY_DYNAMIC_DISPATCH(pairSeamsKernel)(tiles, tile, pixels);
}

void writeOut(DepthTiles& tiles, uint32_t tile) { HWY_DYNAMIC_DISPATCH(writeOutKernel)(tiles, tile); }

}  // namespace sightline
#endif  // HWY_ONCE
