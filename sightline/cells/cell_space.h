// Cells as places: where they are, what is seen from one into another, and what may shut the holes between them.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cells.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"

namespace sightline {

/// A convex cell: a point is in it if dot(plane, (p, 1)) >= 0 for all its planes, whose normals have length 1.
struct CellRegion {
    uint32_t first_plane = 0, plane_count = 0;  ///< of CellSpace::planes
    Box3d bounds;
};

/// What may shut portals: CellPortal::door is its index.
struct CellDoor {
    static constexpr uint64_t kNoKey = ~uint64_t{0};

    std::string name;
    uint64_t key = kNoKey;  ///< of the object that shuts it; kNoKey: no object does
    /// The direction in which its portals shrink while it shuts, of any length. Zero: not known; its portals are then
    /// open as long as it is not shut.
    glm::dvec3 slide{0.0};
};

/// A graph of cells together with the places of the cells: what a bake is made of, and what a world is divided by. The
/// cells are the leaves of a tree, or convex regions of their own.
struct CellSpace {
    CellGraph graph;  ///< cell i is region i or, of a tree, what graph.cell_of_leaf says; leaf i without
    LeafTree tree;    ///< without contents: there is none
    std::vector<CellRegion> regions;  ///< where there is no tree  [size: graph.cells]
    std::vector<glm::dvec4> planes;   ///< of the regions
    std::vector<std::string> names;   ///< of the cells; may be empty  [size: graph.cells]
    std::vector<CellDoor> doors;
    std::vector<uint32_t>
        row_of_cell;  ///< per cell its row of visibility; kNoCell: none, it sees all. Empty: there are no
                      ///< rows
    /// The cell of all that is in no region, entered through holes that nobody marked; its own region says nothing.
    /// kNoCell: what is in no region is solid. Always kNoCell of a tree: its solid leaves are solid.
    uint32_t outside = CellGraph::kNoCell;
    /// How far portals and the bounds of cells may be off: a point that is as close to a cell is in that cell, too.
    double tolerance = 0;  ///< [world units]

    bool ofTree() const { return !tree.contents.empty(); }
    std::span<const glm::dvec4> planesOf(const CellRegion& region) const {
        return {planes.data() + region.first_plane, region.plane_count};
    }
};

}  // namespace sightline
