// Which cells of a graph see one another: bounded from below by rays and from above by what light can flow through portals.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/space/cells.h"

namespace sightline {

/// How far a bake has come.
struct BakeProgress {
    const char* step = "";  ///< "base", "rays", "flow"
    double done = 0;        ///< share of the step's work, in [0, 1]
};

struct CellVisibilitySettings {
    Jobs* jobs = nullptr;  ///< threads to share the work out to; the answer is the same with any
    uint64_t budget = 0;   ///< steps of the flow for each portal and direction: what is not settled then stays visible,
                           ///< and is counted; 0: no limit
    /// Asked between pieces of work; true: stop, and leave what is not settled visible. Not the same on every run.
    std::function<bool()> stop;
    std::function<void(const BakeProgress&)> progress;
};

/// Every ordered pair of cells is witnessed (a ray passes from one into the other with room to spare), proved hidden, or
/// unresolved: visible as far as one knows.
struct CellVisibility {
    BitMatrix visible;         ///< [cells x cells], symmetric; each cell sees itself
    BitMatrix witnessed;       ///< [cells x cells], symmetric; within `visible`
    uint64_t over_budget = 0;  ///< portals and directions whose flow ended by its budget
    bool stopped = false;      ///< by the settings' stop
};

/// @param graph  finite
CellVisibility bakeCellVisibility(const CellGraph& graph, const CellVisibilitySettings& settings = {});

}  // namespace sightline
