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

#include "sightline/bake/directed_portals.h"
#include "sightline/bake/stabbing.h"
#include "sightline/bake/window.h"
#include "sightline/bake/witness_rays.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/math/box.h"

namespace sightline {

/// What a flow found. Rows are over cells.
struct FlowAnswer {
    std::vector<uint64_t> reached;     ///< cells that light of the portal may reach, of those that were asked for
    std::vector<uint32_t> seen;        ///< runs of cells on lines that pass, one after the other ...
    std::vector<uint32_t> seen_first;  ///< ... and where each begins, and where the last ends
    uint64_t steps = 0;                ///< portals that were clipped
    uint64_t empty_chains = 0;         ///< that Teller's test proved to be passed by no line
    bool spent = false;                ///< the budget: then all that were asked for count as reached
};

/// Boxes in cells, and which of them have been found.
struct FlowBoxes {
    std::span<const Box3d> boxes;     ///< about DirectedPortals::center
    std::span<const uint32_t> first;  ///< per cell where its boxes begin in `inside`, and the end
    std::span<const uint32_t> inside;
    std::span<uint8_t> found;  ///< per box
};

/// The lists that flows read: what lies where, for vectors.
class FlowPlaces {
public:
    explicit FlowPlaces(const DirectedPortals& directed);

    const DirectedPortals& directed;
    std::vector<glm::dvec4> spheres;       ///< per portal: center and radius
    std::vector<uint32_t> entering;        ///< portals by the cell that they enter
    std::vector<uint32_t> entering_first;  ///< per cell, and the end
};

/// A thread's own scratch for flows.
class PortalFlow {
public:
    /// @param may  per directed portal what may follow it; may change between flows
    PortalFlow(const FlowPlaces& places, const WitnessRays& rays, const BitMatrix& may);
    ~PortalFlow();

    /// Chases light from a portal into the cells that are asked for.
    /// @param asked   [size: words of a row of cells]
    /// @param budget  steps; 0: no limit
    void from(uint32_t portal, std::span<const uint64_t> asked, uint64_t budget, FlowAnswer& answer);

    /// Chases light from a portal to boxes that are not found yet: a box is found if it reaches above all planes that
    /// bound the light in one of its cells. Of the answer, `reached` and `seen` stay empty; if the budget is spent,
    /// all boxes in cells that the portal may lead to count as found.
    void find(uint32_t portal, const FlowBoxes& boxes, uint64_t budget, FlowAnswer& answer);

    struct State;    ///< of the search
    struct Scratch;  ///< of a thread

private:
    void begin(uint32_t portal, uint64_t budget, FlowAnswer& answer);
    template <class IsAsked>
    bool chaseFrom(uint32_t portal, IsAsked&& is_asked);

    std::unique_ptr<Scratch> scratch_;
};

}  // namespace sightline
