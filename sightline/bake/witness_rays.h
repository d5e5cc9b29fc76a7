// Rays that pass from cell to cell with room to spare: each proves that all cells on its way see one another.
// SPDX-License-Identifier: MIT
//
// John Airey. Increasing Update Rates in the Building Walkthrough System with Automatic Model-Space Subdivision. 1990.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/directed_portals.h"

namespace sightline {

/// Follows lines through the portals of a graph. A line passes a portal if it crosses its plane within the outline, and
/// farther from it than a margin that is far above what rounding can do.
class WitnessRays {
public:
    explicit WitnessRays(const DirectedPortals& directed);

    /// The cells on the line through a point of a portal: those behind it in the order backward, then those in front.
    /// @param at         on the portal's plane
    /// @param direction  not zero; along the portal's normal
    /// @return           the cells; empty if the line does not pass the portal itself
    const std::vector<uint32_t>& through(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction);

    /// Whether a line passes a portal, and where.
    bool passes(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction, double& along) const;

    double margin() const { return margin_; }

private:
    void walk(uint32_t portal, const glm::dvec3& at, const glm::dvec3& direction);

    const DirectedPortals& directed_;
    /// Per point of an outline the edge from it on: inward unit normal in the portal's plane, and its offset less the margin.
    std::vector<glm::dvec4> edges_;
    double margin_;
    std::vector<uint32_t> cells_;
};

}  // namespace sightline
