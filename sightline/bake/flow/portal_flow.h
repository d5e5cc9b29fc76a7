// Light from one portal: the cells that it can fall into, through portals clipped to what can pass the ones before.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
// Michael Abrash. Inside Quake: Visible-Surface Determination. 1996.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sightline/bake/flow/flow_portals.h"
#include "sightline/bake/flow/stabbing.h"
#include "sightline/bake/flow/stop_asker.h"
#include "sightline/bake/flow/window.h"
#include "sightline/bake/flow/witness_rays.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/math/box.h"

namespace sightline::bake {

/// What a flow found. Rows are over cells.
struct FlowAnswer {
    std::vector<uint64_t> reached;     ///< cells that were asked for and that light of the portal may reach
    std::vector<uint32_t> seen;        ///< the cells of each ray that passes, ray after ray
    std::vector<uint32_t> seen_first;  ///< where the cells of each ray begin, and the end
    uint64_t steps = 0;                ///< portals that were clipped
    uint64_t work = 0;                 ///< FlowLimits::work that was done
    uint64_t empty_chains = 0;         ///< chains that Teller's test proved empty
    /// A limit ended it: all cells that were asked for and that a portal leads into which may follow count as reached.
    bool spent = false;
};

/// What ends a flow early.
struct FlowLimits {
    uint64_t steps = 0;         ///< portals that are clipped; 0: no limit
    uint64_t work = 0;          ///< in the cost of looking at one target, some nanoseconds; 0: no limit
    StopAsker* stop = nullptr;  ///< asked every millisecond or so
};

/// Boxes in cells, and which of them have been found.
struct FlowBoxes {
    std::span<const Box3d> boxes;     ///< about FlowPortals::center
    std::span<const uint32_t> first;  ///< per cell where its boxes begin in `inside`, and the end
    std::span<const uint32_t> inside;
    std::span<uint8_t> found;  ///< per box
};

/// What flows read of the portals, laid out for vectors.
class FlowPlaces {
public:
    explicit FlowPlaces(const FlowPortals& directed);

    const FlowPortals& directed;
    std::vector<glm::dvec4> spheres;       ///< per portal: center and radius
    std::vector<uint32_t> entering;        ///< portals by the cell that they enter
    std::vector<uint32_t> entering_first;  ///< per cell, and the end
};

/// Runs flows, one after the other, in the memory of one thread.
class PortalFlow {
public:
    /// @param may  per directed portal what may follow it; may change between flows
    PortalFlow(const FlowPlaces& places, const WitnessRays& rays, const BitMatrix& may);
    ~PortalFlow();

    /// Chases light from a portal into the cells that are asked for.
    /// @param asked   [size: words of a row of cells]
    void from(uint32_t portal, std::span<const uint64_t> asked, const FlowLimits& limits, FlowAnswer& answer);

    /// Chases light from a portal to boxes that are not found yet: a box is found if it reaches above all planes that
    /// bound the light in one of its cells. Of the answer, `reached` and `seen` stay empty; if the budget is spent,
    /// all boxes in cells that the portal may lead to count as found.
    void find(uint32_t portal, const FlowBoxes& boxes, const FlowLimits& limits, FlowAnswer& answer);

    struct State;    ///< of the search
    struct Scratch;  ///< of a thread

private:
    void begin(uint32_t portal, const FlowLimits& limits, FlowAnswer& answer);
    template <class IsAsked>
    bool chaseFrom(uint32_t portal, IsAsked&& is_asked);

    std::unique_ptr<Scratch> scratch_;
};

}  // namespace sightline::bake
