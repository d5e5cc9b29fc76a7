// What drawing a part needs for as long as it lasts. It is too large for a thread's own memory.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <new>

#include "sightline/buffer/draw/edges.h"
#include "sightline/buffer/tiles.h"
#include "sightline/geom/plane_mesh.h"

namespace sightline {

constexpr int kBlockWidth = 32, kBlockHeight = 16, kBlockTiles = 8;  ///< what is covered at once: 4 by 2 tiles
constexpr int kMostColumns = 260;  ///< blocks in a row: images are no wider than 8192 pixels, in whole tiles

/// The image of a part's vertices.
struct PartImage {
    alignas(64) float x[256], y[256], w[256];
    alignas(64) float r[256];  ///< no image is farther from there  [pixels]
    float x0, y0, x1, y1;      ///< of all of them
    float w_min, w_max, r_max;
};

/// An edge in one row of blocks.
struct RowEdge {
    // Columns. Pixels from `crossed` on have their middles right of the edge. The edge touches those from `first` to `end`; from
    // `inner` on, or before it where the inside is on the left, the middles may be on its inner side.
    alignas(64) int32_t crossed[kBlockHeight], first[kBlockHeight], end[kBlockHeight], inner[kBlockHeight];
    uint32_t rows = 0, touched_rows = 0;  ///< whose middles it crosses, and that it touches, as bits
    bool plus = true;                     ///< right of it the winding number is larger
};

/// The edges that meet a block, out of those of its row.
struct BlockEdges {
    const RowEdge* row;
    const uint16_t* list;
    int count;
    int most;  ///< no winding number in the row is larger
};

/// Which edges of a row meet a block, and which ended before it.
struct RowSets {
    static constexpr int kWords = EdgeList::kRoom / 64 + 1;
    uint64_t at[kMostColumns][kWords], left[kMostColumns][kWords];
};

/// Winding numbers modulo 2^kPlanes in bit planes; each bit is a row.
template <int kPlanes>
struct RowWinding {
    uint32_t plane[kPlanes] = {};

    void count(uint32_t rows, bool plus) {
        for (uint32_t& of : plane) {
            const uint32_t carry = (plus ? of : ~of) & rows;
            of ^= rows;
            rows = carry;
        }
    }
    bool isZero() const {
        uint32_t any = 0;
        for (const uint32_t of : plane) any |= of;
        return (any & 0xffffu) == 0;
    }
};

/// A group that is drawn: its depth, and where it may be.
struct GroupDepth {
    float a = 0, b = 0,
          c = 0;      ///< nearness a x + b y + c is no more than that of any of its points; for an outline, no less
    float bound = 0;  ///< its c, for the least 4 pixels around a tile's middle; for an outline, the most
    GroupRect rect;
    uint32_t index = ~0u;  ///< in DepthTiles::planes, once a tile has asked for it
};

/// The planes of a part's groups in the image, side by side.
struct GroupPlanes {
    alignas(64) float a[PlaneMesh::kMostGroups + 8], b[PlaneMesh::kMostGroups + 8], c[PlaneMesh::kMostGroups + 8];
};

struct DrawScratch {
    PartImage image;
    ExactImage exact;
    EdgeList edges;
    GroupPlanes planes;
    GroupDepth groups[PlaneMesh::kMostGroups];
    GroupRect rects[PlaneMesh::kMostGroups];
    RowEdge row_edges[EdgeList::kMost];
    uint16_t block_edges[EdgeList::kMost];
    RowSets sets;
};

/// Made at the first call.
inline DrawScratch& scratchOf(DepthTiles& tiles) {
    const bool fresh = tiles.scratch.empty();
    if (fresh) tiles.scratch.resize(sizeof(DrawScratch) + alignof(DrawScratch));
    const auto at = reinterpret_cast<uintptr_t>(tiles.scratch.data());
    void* const aligned =
        reinterpret_cast<void*>((at + alignof(DrawScratch) - 1) / alignof(DrawScratch) * alignof(DrawScratch));
    return fresh ? *new (aligned) DrawScratch : *static_cast<DrawScratch*>(aligned);
}

}  // namespace sightline
