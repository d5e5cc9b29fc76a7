// Walks the blocks that the edges of a cluster meet or go around, row by row.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_ROWS_INL_H
#undef SIGHTLINE_BUFFER_DRAW_ROWS_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_ROWS_INL_H
#endif

#include <algorithm>
#include <bit>

#include "sightline/buffer/draw/update-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Takes the blocks of an image that the edges meet or go around, and that are open to a nearness.
/// @param take  (column, row, edges, before): the edges in the block, and the winding numbers left of it; returns true to end
/// @returns what `take` has returned
template <int kPlanes, class Take>
bool walkRows(const DepthTiles& tiles, DrawScratch& scratch, float nearest, Take take) {
    RowEdge* const row_edges = scratch.row_edges;
    RowSets& sets = scratch.sets;
    EdgeList& e = scratch.edges;
    const float width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
    float bounds[4] = {3e38f, 3e38f, -3e38f, -3e38f};
    setUpEdges(e, height, bounds);
    if (!(bounds[2] > 0 && bounds[3] > 0 && bounds[0] < width && bounds[1] < height)) return false;
    const int column0 = static_cast<int>(std::max(bounds[0], 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(bounds[2], width - 1)) / kBlockWidth,
              block_row0 = static_cast<int>(std::max(bounds[1], 0.0f)) / kBlockHeight,
              block_row1 = static_cast<int>(std::min(bounds[3], height - 1)) / kBlockHeight;
    for (int by = block_row0; by <= block_row1; ++by) {
        const auto [from, to] = openBlocks(tiles, by, column0, column1, nearest);
        if (to < from) continue;
        const int row0 = kBlockHeight * by;
        RowWinding<kPlanes> before;  // left of the block at hand
        int used = 0, most = 0;
        const int words = (e.count + 63) / 64;
        for (int b = from; b <= to; ++b)
            for (int k = 0; k < words; ++k) sets.at[b][k] = sets.left[b][k] = 0;
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
                setUpRow(e, i, row0, width, edge);
                const int b0 = std::max(static_cast<int>(std::max(low, 0.0f)) / kBlockWidth, from),
                          b1 = static_cast<int>(std::min(std::max(high, 0.0f), width + 64)) / kBlockWidth;
                const uint64_t bit = uint64_t{1} << (used % 64);
                for (int b = b0; b <= std::min(b1, to); ++b) sets.at[b][used / 64] |= bit;
                if (b1 < to) sets.left[b1 + 1][used / 64] |= bit;
                ++used;
            }
        }
        for (int bx = from; bx <= to; ++bx) {
            int count = 0;
            for (int k = 0; k < words; ++k) {
                for (uint64_t left = sets.left[bx][k]; left != 0; left &= left - 1) {
                    const RowEdge& edge = row_edges[64 * k + std::countr_zero(left)];
                    before.count(edge.rows, edge.plus);
                }
                for (uint64_t at = sets.at[bx][k]; at != 0; at &= at - 1)
                    scratch.block_edges[count++] = static_cast<uint16_t>(64 * k + std::countr_zero(at));
            }
            if (count == 0 && before.isZero()) continue;
            if (openTiles(tiles, bx, by, nearest) == 0) continue;
            if (take(bx, by, BlockEdges{row_edges, scratch.block_edges, count, most}, before)) return true;
        }
    }
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
