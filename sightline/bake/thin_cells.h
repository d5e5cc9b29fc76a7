// Cells that are thinner than points are known: made one with what lies on one of their sides.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/space/cells.h"

namespace sightline {

/// A graph without thin cells.
struct ThinMerged {
    CellGraph graph;                     ///< of merged cells; empty if there was nothing to merge
    std::vector<uint32_t> cell_of_cell;  ///< per cell of the old graph; empty if there was nothing to merge
    bool any = false;
};

/// A cell is thin where it is entered and left through portals that lie over one another in one plane, as far as points
/// are known: a line that passes both does not rise from one to the other by more than rounding, and would be taken for
/// none. Such a cell becomes one with the cell on the one side. Two old cells see one another if their new ones do: a
/// superset. O(portals), and O(portals^2) in a cell.
ThinMerged mergeThinCells(const CellGraph& graph);

}  // namespace sightline
