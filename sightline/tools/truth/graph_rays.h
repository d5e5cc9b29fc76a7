// Lines through a graph of cells, from portal to portal: what the graph itself says of who sees whom.
//
// A witness: it takes the record, and shares no code with what computes rows from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/cells/cells.h"
#include "sightline/tools/truth/aimed_holes.h"
#include "sightline/tools/truth/row_check.h"

namespace sightline::tools {

/// A cell that a line has reached, and through what.
struct GraphStep {
    static constexpr uint32_t kStart = ~0u;

    uint32_t cell = 0;
    uint32_t before = kStart;  ///< the step from which it was entered
    double at = 0;             ///< the parameter of the line where it was
};

/// How far inside of a portal's outline a line passes through it.  [world units]
struct PortalMargin {
    double most;      ///< for every portal, or if there is a share:
    double share;     ///< no more than this of the largest coordinate of the portal's own outline,
    double rounding;  ///< and this

    PortalMargin(double of_all, double share_of_own = 0, double own_rounding = 0)
        : most(of_all), share(share_of_own), rounding(own_rounding) {}

    double at(double largest) const { return share > 0 ? std::min(most, share * largest + rounding) : most; }
};

class GraphRays {
public:
    /// @param graph   outlives this  [finite]
    /// @param margin  a line is through a portal if it passes inside of the outline by so much, seen along the portal's
    ///                normal; what passes closer to an edge, or outside, is not through
    GraphRays(const CellGraph& graph, const PortalMargin& margin);

    const CellGraph& graph() const { return graph_; }
    const PortalMargin& margin() const { return margin_; }
    double marginOf(uint32_t portal) const { return margins_[portal]; }
    /// No more than that of any portal with this point in it.
    double marginAt(const glm::dvec3& point) const { return margin_.at(largestCoordinate(point)); }

    /// All cells that a line reaches from a point in a cell, where parameters are above 0. From a convex cell a line
    /// goes on through one portal, or through two that overlap by a tolerance; from a cell that is a union of others,
    /// through each that it crosses after it has entered: steps are a tree. Portals that the line crosses at a slope
    /// of less than 1e-9 are passed by.
    /// @param steps  receives the cell itself first
    void follow(uint32_t cell, const glm::dvec3& point, const glm::dvec3& direction,
                std::vector<GraphStep>& steps) const;

private:
    /// Sizes as of a portal seen from one of its cells.
    struct Exit {
        uint32_t portal;
        uint32_t to;
        double side;  // +1: the normal points into the cell that is left
    };
    bool isThrough(uint32_t portal, const glm::dvec3& point) const;

    const CellGraph& graph_;
    PortalMargin margin_;
    std::vector<uint32_t> first_exit_;
    std::vector<Exit> exits_;
    std::vector<double> margins_;     // per portal
    std::vector<glm::dvec3> inward_;  // per point of the graph: of the edge that begins there, unit, in the plane
};

/// Holds rows of cells against lines through points of portals, half of them on to a point of a portal of a cell that
/// the first one leads to. The steps of a line see one another. Seeded, as checkLeafRows().
RowReport checkCellRows(const GraphRays& rays, const BitMatrix& rows, const RowCheckSettings& settings = {},
                        BitMatrix* seen = nullptr);

}  // namespace sightline::tools
