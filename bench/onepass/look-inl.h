// Asks whether a cluster may show something: its outline outward, at the nearest depth, against what is drawn.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/onepass/ask-inl.h"
#include "bench/onepass/cover-inl.h"
#include "bench/onepass/depth-inl.h"
#include "bench/onepass/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

/// For each tile of a block the most nearness of the groups that may be in it.
void nearnessOfTiles(int column, int row, const GroupDepth* groups, int count, float nearest, float* out) {
    const hn::CappedTag<float, kBlockTiles> f;
    const TileMiddles middles(column, row);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Load(f, middles.x + t), y = hn::Load(f, middles.y + t);
        auto z = hn::Zero(f);
        for (int g = 0; g < count; ++g)
            z = hn::IfThenElse(areIn(f, groups[g].rect, x, y), hn::Max(z, depthAt(f, groups[g], x, y)), z);
        hn::Store(hn::Min(z, hn::Set(f, nearest)), f, out + t);
    }
}

/// Whether one of some pixels of a block may show something that is as near as its tile's nearness.
bool arePixelsOpen(const DepthBlocks& image, const DepthBlock& block, const uint32_t* pixels, const float* nearness,
                   BoxBehindPlanes& behind) {
    const hn::CappedTag<float, kBlockTiles> f;
    alignas(64) uint64_t masks[kBlockTiles];
    tilesOf(pixels, masks);
    uint32_t any = 0, whole = 0, open = 0;
    sortMasks(masks, any, whole);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f))
        open |= bitsOf(f, hn::Le(hn::Load(f, block.base + t), hn::Load(f, nearness + t))) << t;
    for (uint32_t left = any & open; left != 0; left &= left - 1) {
        const int t = std::countr_zero(left);
        if (behind(image, block.plane[t])) continue;
        if ((masks[t] & ~block.seen[t]) != 0 || isTileOpen(block, t, masks[t], image.depths.code(nearness[t])))
            return true;
    }
    return false;
}

/// Whether what the edges bound, with all that they touch, may show something.
bool isOutlineOpen(DepthBlocks& image, DrawScratch& scratch, float nearest, int groups, const AskedBox& box) {
    constexpr int kPlanes = 4;
    BoxBehindPlanes behind(&box);
    const auto take = [&](int column, int row, const BlockEdges& edges, const RowWinding<kPlanes>& before) HWY_ATTR {
        alignas(64) uint32_t pixels[kBlockHeight];
        alignas(32) float nearness[kBlockTiles];
        if (!touchBlock(edges, before, kBlockWidth * column, pixels)) return false;
        const int rows = static_cast<int>(image.height) - kBlockHeight * row,
                  columns = static_cast<int>(image.width) - kBlockWidth * column;
        const uint32_t inside = columns < kBlockWidth ? (1u << columns) - 1 : ~0u;
        for (int y = 0; y < kBlockHeight; ++y) pixels[y] &= y < rows ? inside : 0;
        nearnessOfTiles(column, row, scratch.groups, groups, nearest, nearness);
        return arePixelsOpen(image, image.at(column, row), pixels, nearness, behind);
    };
    return walkRows<kPlanes, false>(image, scratch, nearest * (1 + 1e-6f), take);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
