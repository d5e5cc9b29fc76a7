// Rows of view cells by portals: what no way through a scene's own walls leads to is taken out of them.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sightline/bake/view_cells/row_journal.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/cells/cell_space.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

struct PortalRowSettings {
    std::vector<bool> moves;     ///< ObjectCellSettings::moves
    Jobs* jobs = nullptr;        ///< threads to share the cells out to; the answer is the same with any
    std::function<bool()> stop;  ///< asked between pieces of work; true: what is left stays as it is; may be empty
    std::function<void(double)> progress;  ///< called with the share that is done; may be empty
    RowJournal* journal = nullptr;         ///< ViewCellSettings
};

/// What portals did to rows.
struct PortalRowCounts {
    uint64_t hidden = 0;         ///< pairs that they took away
    uint64_t over_budget = 0;    ///< cells whose flow ended by its work limit: they keep what they had
    uint64_t out_of_bounds = 0;  ///< cells that reach out of the space that has portals: they, too
};

/// Follows light from each view cell, by RegionFlow, and takes out of its row all objects of which no way finds a part. Doors
/// count as open. Objects that are in no cell of the space stay in all rows.
/// @param tree       of the view cells: leaf 0 is all that is outside, and keeps its row
/// @param space      of a tree, each leaf a cell of its own, by cellsOfSoup(); without portals: nothing is done
/// @param object_of  per column of the rows the scene's object
/// @param rows       [leaves of the tree x columns]
PortalRowCounts narrowRows(const LeafTree& tree, const CellSpace& space, const Scene& scene,
                           std::span<const uint32_t> object_of, const PortalRowSettings& settings, BitMatrix& rows);

}  // namespace sightline::bake
