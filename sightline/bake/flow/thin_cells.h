// Merges cells that are thinner than the precision of points with a neighbour.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/cells/cells.h"

namespace sightline::bake {

/// A graph without thin cells.
struct ThinMerged {
    CellGraph graph;                     ///< of merged cells; empty if there was nothing to merge
    std::vector<uint32_t> cell_of_cell;  ///< per cell of the old graph; empty if there was nothing to merge
    bool any = false;
};

/// A cell is thin where it is entered and left through portals that lie over one another in one plane, as far as points
/// are known. A line that passes both rises from one to the other by no more than rounding, and the flow would not
/// count it. Such a cell is merged with its neighbour on one side. Two old cells see one another if their merged cells
/// do, which is a superset. O(portals), and O(portals^2) in a cell.
ThinMerged mergeThinCells(const CellGraph& graph);

}  // namespace sightline::bake
