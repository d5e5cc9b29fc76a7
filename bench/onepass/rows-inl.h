// Walks the blocks that the edges of a cluster meet or go around, row by row.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_ROWS_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_ROWS_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_ROWS_INL_H
#endif

#include <algorithm>
#include <bit>

#include "bench/onepass/cover-inl.h"
#include "bench/onepass/depth-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

/// Takes the blocks of an image that the edges meet or go around, and that are open to a nearness.
/// @param take  (column, row, edges, before): the edges in the block, and the winding numbers left of it; returns true to end
/// @returns what `take` has returned
template <int kPlanes, bool kInner, class Take>
bool walkRows(DepthBlocks& image, DrawScratch& scratch, float nearest, Take take) {
    RowEdge* const row_edges = scratch.row_edges;
    RowLists& lists = scratch.lists;
    EdgeList& e = scratch.edges;
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    float bounds[4] = {3e38f, 3e38f, -3e38f, -3e38f};
    setUpEdges(e, height, bounds);
    if (!(bounds[2] > 0 && bounds[3] > 0 && bounds[0] < width && bounds[1] < height)) return false;
    const int column0 = static_cast<int>(std::max(bounds[0], 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(bounds[2], width - 1)) / kBlockWidth,
              block_row0 = static_cast<int>(std::max(bounds[1], 0.0f)) / kBlockHeight,
              block_row1 = static_cast<int>(std::min(bounds[3], height - 1)) / kBlockHeight;
    for (int by = block_row0; by <= block_row1; ++by) {
        const auto [from, to] = openBlocks(image, by, column0, column1, nearest);
        if (to < from) continue;
        const int row0 = kBlockHeight * by;
        RowWinding<kPlanes> before;  // left of the block at hand
        int used = 0, most = 0;      // no winding number in the row is larger than `most`
        for (int b = from; b <= to; ++b) lists.count[b] = lists.left_count[b] = 0;
        RowPlaces places;
        for (int at = 0; at < e.count; at += 16) {
            placeEdges(e, at, row0, static_cast<float>(kBlockWidth * (to + 1)), places);
            if (e.count - at < 16) places.meets &= (1u << (e.count - at)) - 1;
            for (uint32_t left = places.meets; left != 0; left &= left - 1) {
                const int k = std::countr_zero(left), i = at + k, first = places.first[k], last = places.last[k],
                          begin = places.begin[k], end = places.end[k];
                const float low = places.low[k], high = places.high[k];
                const uint32_t rows = ((1u << end) - 1) & ~((1u << begin) - 1);
                const bool plus = (e.change[i] > 0) != (e.up[i] == 1);
                most += plus;
                if (high < static_cast<float>(kBlockWidth * from)) {
                    before.count(rows, plus);
                    continue;
                }
                RowEdge& edge = row_edges[used];
                edge.rows = rows;
                edge.touched_rows = ((2u << last) - 1) & ~((1u << first) - 1);
                edge.plus = plus;
                setUpRow<kInner>(e, i, row0, width, edge);
                const int b0 = std::max(static_cast<int>(std::max(low, 0.0f)) / kBlockWidth, from),
                          b1 = static_cast<int>(std::min(std::max(high, 0.0f), width + 64)) / kBlockWidth;
                for (int b = b0; b <= std::min(b1, to); ++b)
                    lists.at[b][lists.count[b]++] = static_cast<uint16_t>(used);
                if (b1 < to) lists.left[b1 + 1][lists.left_count[b1 + 1]++] = static_cast<uint16_t>(used);
                ++used;
            }
        }
        for (int bx = from; bx <= to; ++bx) {
            for (int k = 0; k < lists.left_count[bx]; ++k) {
                const RowEdge& edge = row_edges[lists.left[bx][k]];
                before.count(edge.rows, edge.plus);
            }
            if (lists.count[bx] == 0 && before.isZero()) continue;
            if (!(image.leastBase(bx, by) < nearest)) continue;
            if (take(bx, by, BlockEdges{row_edges, lists.at[bx], lists.count[bx], most}, before)) return true;
        }
    }
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
