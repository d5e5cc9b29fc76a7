// A cell graph laid out for light: each portal twice, once for each way through it, sorted by the cell that it leaves.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cells.h"

namespace sightline::bake {

/// How well the points of a graph are taken to be known, of the largest coordinate: a few units in the last place, and
/// what a chain of a map compiler's clips adds, which is a few thousand times that.
inline constexpr double kGraphPrecision = 0x1p-35;
/// No portal's points are taken to be known worse than this, of the largest of its own coordinates, however far off others
/// are: a 32nd of the last place of a float. It is more than kGraphPrecision, for portals of a tree reach beyond their
/// faces by 2^-39 of the tree's largest coordinate, and what only does so must not count as above a plane.
inline constexpr double kPortalPrecision = 0x1p-29;

/// A portal and a way through it. Its plane's normal points along the way, into the cell that is entered.
struct FlowPortal {
    glm::dvec3 normal{0.0};
    double offset = 0;  ///< dot(normal, p) + offset: the height of p, negative in the cell that is left
    glm::dvec3 center{0.0};
    double radius = 0;      ///< no point of the outline is farther from the center
    double bend = 0;        ///< no point of the outline is farther from the plane
    double precision = 0;   ///< how well its points are known  [world units]
    double above = 0;       ///< a portal that reaches no higher than this is not passed after this one
    bool straight = false;  ///< Window::straight
    uint32_t first = 0,
             count = 0;         ///< of FlowPortals::points; counter-clockwise as seen from the tip of the normal
    uint32_t from = 0, to = 0;  ///< cells
    uint32_t reverse = 0;       ///< the other way through it
    uint32_t portal = 0;        ///< of the graph
    uint32_t sheet = 0;  ///< portals of one sheet lie in one plane, exactly: none of them is passed after another

    double height(const glm::dvec3& point) const { return glm::dot(normal, point) + offset; }
};

struct FlowPortals {
    std::vector<FlowPortal> portals;      ///< sorted by the cell that they leave
    std::vector<uint32_t> first_of_cell;  ///< [size: cells + 1] the portals that leave cell c: from first_of_cell[c] on
    std::vector<glm::dvec3> points;       ///< the graph's points less `center`
    glm::dvec3 center{0.0};
    double extent = 0;    ///< no coordinate of a point is larger
    double rounding = 0;  ///< what sums of three products of coordinates with unit vectors may be off by  [world units]
    double precision = 0;  ///< no portal's points are known worse: searches that keep more the larger it is take it for
                           ///< all  [world units]

    uint32_t cells() const { return static_cast<uint32_t>(first_of_cell.size()) - 1; }
    uint32_t size() const { return static_cast<uint32_t>(portals.size()); }
    std::span<const glm::dvec3> outline(uint32_t portal) const {
        return {points.data() + portals[portal].first, portals[portal].count};
    }
};

/// Points closer than the precision of both their portals become one; outlines that are not convex are replaced by their
/// convex hulls, so that the portals only grow.
FlowPortals flowPortalsOf(const CellGraph& graph);

}  // namespace sightline::bake
