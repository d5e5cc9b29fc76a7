// Leaves of a tree that are open to one another, as groups: what a room with a pillar is cut into belongs together.
// SPDX-License-Identifier: MIT
//
// John Airey. Increasing Update Rates in the Building Walkthrough System with Automatic Model-Space Subdivision. 1990.
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/cells/cells.h"
#include "sightline/geom/leaf_tree.h"

namespace sightline {

struct OpenGroupSettings {
    double openness =
        0.5;  ///< share of a node's section that portals must cover for its two sides to become one  [0, 1]
    double largest = 1.0 / 16;  ///< a group's diagonal, as a share of the tree's bounds'
};

struct OpenGroups {
    std::vector<uint32_t> group_of_cell;
    uint32_t groups = 0;
};

/// Groups the cells of a tree from the leaves up: what lies on the two sides of a node becomes one group if each side
/// is one, and the node's section, all that the planes above leave of its plane, is open enough. So a group is a
/// convex part of space less the solid leaves in it, as a map compiler's clusters are. Two groups see one another if
/// two of their cells do, so that visibility of groups is a superset. O(nodes * depth + portals).
/// @param graph  cellsOfTree() of the tree: a cell a leaf
OpenGroups groupOpenCells(const LeafTree& tree, const CellGraph& graph, const OpenGroupSettings& settings = {});

}  // namespace sightline
