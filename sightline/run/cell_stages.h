// The stages of a query that go by cells: asked once per view, before the walks.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/cull/portals.h"
#include "sightline/cull/pvs.h"
#include "sightline/run/admission.h"
#include "sightline/run/world.h"

namespace sightline::detail {

/// What they need stays from view to view: rows of visibility as long as the eye's cells stay the same, and what is in
/// them as long as the snapshot does, too.
class CellStages {
public:
    explicit CellStages(Memory* memory);

    /// Finds where the eye is, what may be seen from there, and which objects are in that.  O(what is seen), but for
    /// objects outside of the view's layers.
    /// @returns null: neither stage culls anything; good until the next call
    const Admission* run(const Snapshot& now, const View& view);

    /// Of the last call. What was kept because the eye is in no cell, or the work was spent, counts as in doubt.
    uint64_t doubt(Stage stage) const { return doubt_[static_cast<int>(stage)]; }
    uint64_t nanoseconds(Stage stage) const { return nanoseconds_[static_cast<int>(stage)]; }
    /// The cells that the eye may be in; none: it is in none, or the stages are off.
    std::span<const uint32_t> start() const { return start_; }
    /// Null unless Stage::kPortals had something to say.
    const PortalFlood* flood() const { return flooded_ ? &flood_ : nullptr; }
    const PortalStats& portalStats() const { return portal_stats_; }

private:
    const Admission* decide(const View& view);
    void fillPvs();
    void fillWindows(const glm::dvec3& eye);

    Snapshot now_;  ///< that `admission_` is about
    uint32_t layers_ = 0;
    bool pvs_filled_ = false;
    Array<uint32_t> start_;
    PotentiallyVisible pvs_;
    std::shared_ptr<const AttachedCells> pvs_of_;
    PortalFlood flood_;
    Admission admission_;
    bool flooded_ = false;
    PortalStats portal_stats_;
    uint64_t doubt_[2] = {}, nanoseconds_[2] = {};
};

}  // namespace sightline::detail
