// Coarser graphs of cells, and which cells hang together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/cells/cells.h"

namespace sightline {

/// The graph with cells made one: a cell is the union of all that were given its number, and its portals are those that
/// led out of it. Cells need not be convex any more, nor hang together; visibility through portals holds for them all
/// the same, as a cell that is entered is left through any of its portals.
///
/// Some portals of a merged pair may lie side by side in one plane: they stay apart, for their union need not be
/// convex; joinPortals() makes them one.
/// O(portals).
/// @param cell_of_cell  the new number of each cell, or CellGraph::kNoCell: it is a wall from now on  [size:
///                      graph.cells]
/// @param cells         how many there are then; every number is less
CellGraph mergeCells(const CellGraph& graph, std::span<const uint32_t> cell_of_cell, uint32_t cells);

/// The graph with all portals of one pair of cells that lie in one plane, the same to the last bit, made one: their
/// convex hull. There are fewer chains of portals then, and more gets through them: visibility is a superset. Doors
/// stay portals of their own. O(portals log portals).
CellGraph joinPortals(const CellGraph& graph);

/// The new number of each cell from new numbers of the leaves, as a compiler's list of clusters has them. A cell whose
/// leaves were given several numbers takes the first; one without leaves, or whose leaves have none, takes kNoCell.
/// @param number_of_leaf  or CellGraph::kNoCell  [size: graph.cell_of_leaf.size() or less]
std::vector<uint32_t> cellsFromLeaves(const CellGraph& graph, std::span<const uint32_t> number_of_leaf);

/// Which cells can be reached from one another through portals, doors open: a number for each cell, counted from 0 in
/// the order of their first cells. O(portals).
std::vector<uint32_t> groupsOf(const CellGraph& graph);

}  // namespace sightline
