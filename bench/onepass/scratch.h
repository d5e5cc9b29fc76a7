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
    alignas(64) float x[256], y[256];
    float x0, y0, x1, y1;  ///< of all of them
    float w_min, w_max;
};

/// An edge in one row of blocks.
struct RowEdge {
    // Columns. Pixels from `crossed` on have their middles right of the edge. The edge touches those from `first` to `end`,
    // of which the middles may be on its inner side.
    alignas(64) int32_t crossed[kBlockHeight], first[kBlockHeight], end[kBlockHeight];
    uint32_t rows = 0, touched_rows = 0;  ///< whose middles it crosses, and that it touches, as bits
    bool plus = true;                     ///< right of it the winding number is larger
};

/// Winding numbers modulo four in two bit planes; each bit is a row.
struct RowWinding {
    uint32_t low = 0, high = 0;

    void count(uint32_t rows, bool plus) {
        const uint32_t carry = (plus ? low : ~low) & rows;
        low ^= rows;
        high ^= carry;
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
    float least = 0;  ///< of the plane, 4 pixels around a tile's middle: what its c is there
    GroupRect rect;
    uint32_t index = DepthBlock::kNoPlane;  ///< in DepthBlocks::planes, once a tile has asked for it
};

/// The planes of a cluster's groups in the image, side by side: a x + b y + c is no nearer than any of their points.
struct GroupPlanes {
    alignas(64) float a[PlaneMesh::kMostGroups + 8], b[PlaneMesh::kMostGroups + 8], c[PlaneMesh::kMostGroups + 8];
};

struct DrawScratch {
    ClusterImage image;
    EdgeList edges;
    GroupPlanes planes;
    GroupDepth groups[PlaneMesh::kMostGroups];
    GroupRect rects[PlaneMesh::kMostGroups];
    RowEdge row_edges[EdgeList::kMost];
    RowLists lists;
};

}  // namespace sightline::bench
