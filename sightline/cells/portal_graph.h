// A graph of cells laid out for a walk each frame: the portals that leave a cell stand together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/cells/cell_space.h"
#include "sightline/math/box.h"

namespace sightline {

/// A portal as it is seen from one of its two cells.
struct DirectedPortal {
    glm::dvec4 plane{0.0};  ///< the normal points into the cell that is left
    uint32_t first = 0;     ///< of PortalGraph::corners
    uint32_t count = 0;
    uint32_t to = 0;                    ///< the cell that is entered
    uint32_t portal = 0;                ///< index into CellGraph::portals
    uint32_t door = CellPortal::kNone;  ///< index into CellSpace::doors
    float thickness = 0;                ///< no corner lies farther from the plane; rounded up [world units]
};

/// Corners of outlines; each coordinate is an array of its own. The last corner of each outline is repeated, so that
/// corners can be read four at a time.
struct PortalCorners {
    const double* x;
    const double* y;
    const double* z;
};

/// Made once of a CellSpace; immutable, so that any number of threads may walk it.
class PortalGraph {
public:
    static constexpr uint32_t kNoCell = CellGraph::kNoCell;

    /// A node of the tree, if there is one. Children as in LeafTreeNode, but with cells instead of leaves: from kLeaf
    /// on, kLeaf and a cell's number, or kSolid.
    struct Node {
        static constexpr uint32_t kLeaf = LeafTreeNode::kLeaf, kSolid = ~0u;

        glm::dvec4 plane{0.0};
        uint32_t child[2] = {kSolid, kSolid};  ///< behind, in front
        uint32_t parent = kNoCell;             ///< kNoCell: none
    };

    /// @param space  finite
    explicit PortalGraph(const CellSpace& space, Memory* memory = defaultMemory());

    uint32_t cells() const { return cells_; }
    uint32_t portals() const { return portals_; }
    uint32_t doors() const { return static_cast<uint32_t>(slides_.size()); }
    uint32_t outside() const { return outside_; }  ///< CellSpace::outside
    /// kNoCell: it has none
    uint32_t rowOf(uint32_t cell) const {
        SIGHTLINE_DEBUG_ASSERT(cell < cells_);
        return row_of_cell_.empty() ? kNoCell : row_of_cell_[cell];
    }

    /// The cells that a convex body meets, or comes as close to as the space's tolerance: points and a radius around
    /// their hull.
    /// @param cells  receives them, each once, rising
    /// @returns false if a part of the body may be in no cell, for it comes as close to where none is: then it is not known
    ///          what is seen from there
    bool cellsAround(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const;
    /// The same for a box, to find the cells that an object stands in. A box that reaches out of all regions gets the
    /// cells that it reaches into, and the outside if there is one.
    /// @returns false if it is in no cell at all, or reaches beyond the bounds of a tree
    bool cellsOf(const Box3d& box, Array<uint32_t>& cells) const;

    /// The portals that leave a cell.
    std::span<const DirectedPortal> portalsFrom(uint32_t cell) const {
        SIGHTLINE_DEBUG_ASSERT(cell < cells_);
        return {directed_.data() + first_[cell], first_[cell + 1] - first_[cell]};
    }
    PortalCorners corners() const { return {x_.data(), y_.data(), z_.data()}; }
    /// Of a door: CellDoor::slide.
    const glm::dvec3& slideOf(uint32_t door) const {
        SIGHTLINE_DEBUG_ASSERT(door < slides_.size());
        return slides_[door];
    }
    /// How far anything may be off: the space's tolerance and what rounding to doubles of this size moves.
    double tolerance() const { return tolerance_; }
    /// The largest coordinate.
    double reach() const { return reach_; }

    /// The tree from its root, if a cell hangs in it once; else none: cells then have no order.
    std::span<const Node> nodes() const { return ordered_ ? std::span<const Node>(nodes_) : std::span<const Node>(); }
    /// The node above a cell; kNoCell: none.
    uint32_t parentOf(uint32_t cell) const {
        SIGHTLINE_DEBUG_ASSERT(cell < parent_of_cell_.size());
        return parent_of_cell_[cell];
    }

private:
    /// Of a tree over the boxes of regions: both children stand side by side.
    struct BoxNode {
        Box3d box;
        uint32_t first = 0, count = 0;  ///< of order_; count 0: `first` is the first of two nodes
    };

    void layPortals(const CellSpace& space);
    void layTree(const CellSpace& space);
    void layRegions(const CellSpace& space);
    void splitBoxes(uint32_t node, uint32_t first, uint32_t count);
    template <class Visit>
    void visitRegions(const Box3d& box, Visit visit) const;
    bool cellsOfTree(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const;
    bool cellsOfRegions(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const;
    bool isCovered(std::span<const glm::dvec3> points, std::span<const uint32_t> regions) const;

    uint32_t cells_ = 0, portals_ = 0, outside_ = kNoCell;
    double tolerance_ = 0, reach_ = 0;
    bool of_tree_ = false, ordered_ = false;
    Box3d bounds_;
    Array<uint32_t> first_;
    Array<DirectedPortal> directed_;
    Array<double> x_, y_, z_;
    Array<glm::dvec3> slides_;
    Array<uint32_t> row_of_cell_;
    Array<Node> nodes_;
    uint32_t root_ = Node::kSolid;
    Array<uint32_t> parent_of_cell_;
    Array<CellRegion> regions_;
    Array<glm::dvec4> planes_;
    Array<BoxNode> boxes_;
    Array<uint32_t> order_;
};

}  // namespace sightline
