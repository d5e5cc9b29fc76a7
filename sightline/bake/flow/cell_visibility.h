// Which cells of a graph see one another: rays bound it from below, light that flows through portals from above.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/cells/cells.h"

namespace sightline::bake {

/// How far a bake has come.
struct BakeProgress {
    const char* step = "";  ///< "base", "rays", "flow"
    double done = 0;        ///< share of the step's work, in [0, 1]
};

/// What a bake knows between two pieces of its work: a bake of the same graph with the same budget goes on from here,
/// and ends with the same answer.
struct CellVisibilityState {
    uint64_t flowed = 0;       ///< directed portals whose flow is done: the first of `order`
    uint64_t over_budget = 0;  ///< of these, how many ended by their budget
    uint64_t steps = 0;
    uint64_t work = 0;  ///< CellVisibilitySettings::work that is done
    uint64_t empty_chains = 0;
    BitMatrix may;                ///< [directed portals x directed portals] what may follow what
    BitMatrix witnessed;          ///< [cells x cells]
    BitMatrix reached;            ///< [cells x cells] by the flows out of the row's cell
    std::vector<uint32_t> order;  ///< the order of the flows, as directed portals
};

struct CellVisibilitySettings {
    Jobs* jobs = nullptr;  ///< threads to share the work out to; the answer is the same with any
    uint64_t budget = 0;   ///< steps of the flow for each portal and direction: what is not settled then stays visible,
                           ///< and is counted; 0: no limit
    /// What the flows of all portals may cost together, in looks at a target, some nanoseconds each; 0: no limit. Half of it is
    /// for few portals that need much, and half is shared out alike. What is not settled then stays visible, and is counted.
    uint64_t work = 0;
    /// Sight ends so far from the eye, as at a far plane or in fog: pairs of cells without points as close as this are
    /// not visible. 0: no limit  [world units]
    double farthest = 0;
    /// Asked between pieces of work, some times a second, by whichever thread works, one at a time; true: stop, and leave
    /// what is not settled visible. The answer then hangs on time.
    std::function<bool()> stop;
    std::function<void(const BakeProgress&)> progress;
    /// Called between pieces of work with the whole state. A caller who writes it down can go on after a crash.
    std::function<void(const CellVisibilityState&)> checkpoint;
    /// The state of a checkpoint of this graph and budget to go on from, or null. The bake takes it apart.
    CellVisibilityState* resume = nullptr;
    bool keep_follows = false;  ///< fill CellVisibility::follows
};

/// Every ordered pair of cells is witnessed (a ray passes from one into the other with room to spare), proved hidden,
/// or unresolved: visible as far as one knows.
struct CellVisibility {
    BitMatrix visible;          ///< [cells x cells], symmetric; each cell sees itself
    BitMatrix witnessed;        ///< [cells x cells], symmetric; within `visible`
    BitMatrix follows;          ///< which portal may follow which, for bakeBoxVisibility(); or empty
    uint64_t over_budget = 0;   ///< directed portals whose flow ended by the budget or by its share of the work
    uint64_t steps = 0;         ///< portals that were clipped
    uint64_t empty_chains = 0;  ///< chains that Teller's test proved empty after clipping left something
    bool stopped = false;       ///< by the settings' stop
};

/// The work that suffices for maps whose flows end by themselves in a few minutes, and that bounds the others.
constexpr uint64_t kUsualWork = 40'000'000'000;

/// A bake holds two matrices with a row and a column per directed portal. With more portals than this they would take
/// more than 4 GiB.
constexpr size_t kMostBakedPortals = 65536;

/// The promise: a line that passes from cell to cell through the graph's portals, where these are known to within
/// kGraphPrecision (flow_portals.h), is within `visible` for all cells on it; lines that only touch portals' outlines
/// count. A portal that is no wider than twice that may be there or not: cells of a tree that touch in an edge have one.
/// docs/techniques/pvs.md has the argument. With `farthest` it holds for segments that are no longer.
///
/// The same bits for any number of threads, any instruction set, and with or without a resume.
/// @param graph  finite, of at most kMostBakedPortals portals; a cell that is not convex counts as empty space: nothing
///               in it hides anything
CellVisibility bakeCellVisibility(const CellGraph& graph, const CellVisibilitySettings& settings = {});

}  // namespace sightline::bake
