// What drawing a cluster needs for as long as it lasts. It is too large for a thread's own memory.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "bench/onepass/blocks.h"
#include "bench/onepass/edges.h"
#include "bench/onepass/mesh.h"

namespace sightline::bench {

/// The image of a cluster's vertices.
struct ClusterImage {
    alignas(64) float x[256], y[256], w[256];
    alignas(64) float r[256];  ///< no image is farther from there  [pixels]
    float x0, y0, x1, y1;      ///< of all of them
    float w_min, w_max, r_max;
};

/// An edge in one row of blocks.
struct RowEdge {
    // Columns. Pixels from `crossed` on have their middles right of the edge. The edge touches those from `first` to `end`; for
    // drawing, those alone of which the middles may be on its inner side.
    alignas(64) int32_t crossed[kBlockHeight], first[kBlockHeight], end[kBlockHeight];
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

struct RowLists {
    int count[kMostColumns], left_count[kMostColumns];
    uint16_t at[kMostColumns][EdgeList::kMost],
        left[kMostColumns][EdgeList::kMost];  ///< that meet a block; that ended before
};

/// A group that is drawn: its depth, and where it may be.
struct GroupDepth {
    ImagePlane plane;
    float bound = 0;  ///< its c, for the least 4 pixels around a tile's middle; for a look, for the most
    GroupRect rect;
    uint32_t index = DepthBlock::kNoPlane;  ///< in DepthBlocks::planes, once a tile has asked for it
};

/// The planes of a cluster's groups in the image, side by side: a x + b y + c is no nearer than any of their points.
struct GroupPlanes {
    alignas(64) float a[PlaneMesh::kMostGroups + 8], b[PlaneMesh::kMostGroups + 8], c[PlaneMesh::kMostGroups + 8];
};

struct DrawScratch {
    ClusterImage image;
    ExactImage exact;
    EdgeList edges;
    GroupPlanes planes;
    GroupDepth groups[PlaneMesh::kMostGroups];
    GroupRect rects[PlaneMesh::kMostGroups];
    RowEdge row_edges[EdgeList::kMost];
    RowLists lists;
};

}  // namespace sightline::bench
