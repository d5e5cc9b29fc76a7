// Convex cells joined by convex portals: what a sight line passes through, from cell to cell.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sightline {

/// A hole in the common face of two cells.
struct CellPortal {
    static constexpr uint32_t kNone = ~0u;

    uint32_t cells[2] = {0, 0};     ///< that it joins; two different ones
    uint32_t first = 0, count = 0;  ///< its outline: a convex polygon, counter-clockwise as seen from cells[0]
    glm::dvec4 plane{0.0};          ///< of the outline; the unit normal points from cells[1] into cells[0]
    double thickness = 0;           ///< no point of the outline lies farther from the plane [world units]
    uint32_t door = kNone;          ///< the number of what may shut it; kNone: nothing does
    bool one_way = false;           ///< light comes through to an eye in cells[0] alone: cells[1] sees a wall there
};

/// A graph of cells. Cells have numbers and no shape of their own: a cell is the room that its portals and walls
/// enclose. Light goes from cell to cell through portals only. So a sight line passes a chain of portals, and
/// visibility is computed from the portals alone.
///
/// A map's leaves belong to cells; a map lists what is drawn by leaf.
struct CellGraph {
    static constexpr uint32_t kNoCell = ~0u;

    uint32_t cells = 0;
    std::vector<glm::dvec3> points;
    std::vector<CellPortal> portals;
    std::vector<uint32_t> cell_of_leaf;  ///< per leaf of the map; kNoCell: solid, or cut off from all cells

    std::span<const glm::dvec3> outline(const CellPortal& portal) const {
        return {points.data() + portal.first, portal.count};
    }
    /// Adds a portal, and finds its plane: the mean plane of the outline (Newell's), its normal into `a`.
    /// @param outline  counter-clockwise as seen from a  [size: 3 or more]
    ///                 an outline that crosses itself so that its parts cancel out becomes its hull, and for want of a
    ///                 sense of rotation two portals, one each way
    /// @return         false, and nothing is added, if it has no area or is not finite
    bool addPortal(uint32_t a, uint32_t b, std::span<const glm::dvec3> outline, uint32_t door = CellPortal::kNone);
    /// Adds a portal whose plane is known better than a thin outline would tell.
    /// @param outline  counter-clockwise as seen from a  [size: 3 or more] [finite]
    /// @param plane    its unit normal points into a
    void addPortal(uint32_t a, uint32_t b, std::span<const glm::dvec3> outline, const glm::dvec4& plane);
};

/// What is wrong with a graph, or odd about it. Visibility is conservative in any case, as the checks say.
struct CellFaults {
    uint64_t bent_portals = 0;     ///< thicker than the tolerance
    uint64_t concave_portals = 0;  ///< outlines that are not convex: their hull is taken
    uint64_t concave_cells =
        0;                  ///< of which some portal's point lies behind another's plane by more than the tolerance
    double worst_bend = 0;  ///< [world units]
    double worst_concavity = 0;  ///< how far behind  [world units]
    uint32_t worst_cell = CellGraph::kNoCell;
};

/// O(sum over cells of portals^2).
/// @param tolerance  [world units]
CellFaults checkCells(const CellGraph& graph, double tolerance);

}  // namespace sightline
