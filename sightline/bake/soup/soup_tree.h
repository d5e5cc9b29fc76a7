// A tree of planes over a scene without marks: the planes of its large opaque sheets divide space into convex cells.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/bake/soup/soup_walls.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"

namespace sightline::bake {

struct SoupTreeSettings {
    double bend = 0;                  ///< what is no farther from a plane is not split by it  [world units] [> 0]
    double least_area = 0;            ///< sheets divide a cell in which they have as much  [world units^2] [> 0]
    uint32_t most_leaves = 1u << 15;  ///< [limit: >= 1]
};

struct SoupTree {
    static constexpr uint32_t kNoSheet = ~0u;

    LeafTree tree;                        ///< all its leaves are empty
    std::vector<uint32_t> sheet_of_node;  ///< of SoupWalls::sheets; kNoSheet: the plane is no sheet's
    uint32_t depth = 0;                   ///< nodes on the longest way down
    bool full = false;                    ///< it was stopped by `most_leaves`
};

/// Which planes divide what costs tightness and time alone, never an answer. Of the largest sheets in a cell, its node
/// takes the one with the largest opaque share of the cell's section, less half of the share of what it would split.
/// O(pieces * depth). Deterministic.
/// @param bounds  of the tree; the walls lie within
SoupTree treeOfSheets(const SoupWalls& walls, const Box3d& bounds, const SoupTreeSettings& settings);

}  // namespace sightline::bake
