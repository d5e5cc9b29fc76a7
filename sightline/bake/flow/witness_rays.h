// Rays that pass from cell to cell with room to spare: each proves that all cells on its way see one another.
// SPDX-License-Identifier: MIT
//
// John Airey. Increasing Update Rates in the Building Walkthrough System with Automatic Model-Space Subdivision. 1990.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/flow/flow_portals.h"

namespace sightline::bake {

/// Follows lines through the portals of a graph. A line passes a portal if it crosses its plane within the outline, and
/// farther from it than a margin that is far above what rounding can do.
class WitnessRays {
public:
    explicit WitnessRays(const FlowPortals& directed);

    /// The cells on the line through a point of a portal: those behind it, the nearest first, then those in front of
    /// it.
    /// @param at         on the portal's plane
    /// @param direction  not zero; along the portal's normal
    /// @param cells      empty if the line does not pass the portal itself
    void through(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction,
                 std::vector<uint32_t>& cells) const;

private:
    bool passes(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction, double& along) const;
    void walk(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction, std::vector<uint32_t>& cells) const;

    const FlowPortals& directed_;
    /// Per point of an outline the edge from it on: inward unit normal in the portal's plane, and its offset less the
    /// margin.
    std::vector<glm::dvec4> edges_;
    double margin_;
};

}  // namespace sightline::bake
