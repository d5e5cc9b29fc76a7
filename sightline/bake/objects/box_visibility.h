// Which boxes, objects or regions, are seen from the cells of a graph: tighter than which cells these lie in.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/cells/cells.h"
#include "sightline/math/box.h"

namespace sightline::bake {

/// Boxes, and the cells that each of them reaches into. Where a cell is left out, what is seen of the box there is
/// missed.
struct CellBoxes {
    std::vector<Box3d> boxes;             ///< one that is not finite is seen from everywhere
    std::vector<uint32_t> first_cell{0};  ///< per box where its cells begin, and the end
    std::vector<uint32_t> cells;

    /// @param in  the cells; none: the box is seen from everywhere
    void add(const Box3d& box, std::span<const uint32_t> in) {
        boxes.push_back(box);
        cells.insert(cells.end(), in.begin(), in.end());
        first_cell.push_back(static_cast<uint32_t>(cells.size()));
    }
};

struct BoxVisibility {
    BitMatrix visible;         ///< [cells x boxes]
    uint64_t by_cells = 0;     ///< pairs that would be visible if a cell saw every box in every visible cell
    uint64_t over_budget = 0;  ///< portals and directions whose flow ended by its budget
    bool stopped = false;
};

/// Teller's cell-to-object visibility, and cell-to-region: a box is visible from a cell if it lies in that cell, or
/// if light that flows from one of the cell's portals through chains of portals reaches a cell that it lies in, and
/// there the box is not wholly below one of the planes that separate the first window of the chain from its last: the
/// light's antipenumbra lies above all of them. A superset of what can be seen; a subset of what lies in visible
/// cells. Same bits for any number of threads.
/// @param cells     bakeCellVisibility() of the same graph, with keep_follows
/// @param settings  jobs, budget, stop and progress count
BoxVisibility bakeBoxVisibility(const CellGraph& graph, const CellVisibility& cells, const CellBoxes& boxes,
                                const CellVisibilitySettings& settings = {});

}  // namespace sightline::bake
