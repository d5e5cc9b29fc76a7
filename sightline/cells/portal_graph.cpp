// The layout: portals sorted by the cell that they leave, the tree's leaves as cells.
// SPDX-License-Identifier: MIT
#include "sightline/cells/portal_graph.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/base/assert.h"
#include "sightline/math/round_outward.h"

namespace sightline {
namespace {

double farOf(const glm::dvec3& point) {
    const glm::dvec3 far = glm::abs(point);
    return std::max({far.x, far.y, far.z});
}

/// From how many of its cells a portal is seen through: the first ones.
uint32_t waysOf(const CellPortal& portal) { return portal.one_way ? 1 : 2; }

/// Which cell each leaf of the tree is.
std::vector<uint32_t> cellsOfLeaves(const CellSpace& space) {
    if (!space.graph.cell_of_leaf.empty()) return space.graph.cell_of_leaf;
    std::vector<uint32_t> cells(space.tree.contents.size(), CellGraph::kNoCell);
    for (uint32_t leaf = 0; leaf < cells.size() && leaf < space.graph.cells; ++leaf)
        if (space.tree.contents[leaf] != LeafContents::kSolid) cells[leaf] = leaf;
    return cells;
}

}  // namespace

PortalGraph::PortalGraph(const CellSpace& space, Memory* memory)
    : first_(memory),
      directed_(memory),
      x_(memory),
      y_(memory),
      z_(memory),
      slides_(memory),
      row_of_cell_(memory),
      nodes_(memory),
      parent_of_cell_(memory),
      regions_(memory),
      planes_(memory),
      boxes_(memory),
      order_(memory) {
    cells_ = space.graph.cells;
    portals_ = static_cast<uint32_t>(space.graph.portals.size());
    of_tree_ = space.ofTree();
    outside_ = of_tree_ ? kNoCell : space.outside;
    row_of_cell_.assign(space.row_of_cell.begin(), space.row_of_cell.end());
    for (const CellDoor& door : space.doors) slides_.push_back(door.slide);
    for (const glm::dvec3& point : space.graph.points) reach_ = std::max(reach_, farOf(point));
    layPortals(space);
    if (of_tree_) layTree(space);
    else layRegions(space);
    // Heights above planes are sums of products with coordinates: each rounds by 2^-53 of them at most, a few times.
    tolerance_ = space.tolerance + 0x1p-46 * reach_;
}

void PortalGraph::layPortals(const CellSpace& space) {
    const CellGraph& graph = space.graph;
    first_.assign(cells_ + 1, 0);
    size_t ways = 0;
    for (const CellPortal& portal : graph.portals) {
        SIGHTLINE_DEBUG_ASSERT(portal.cells[0] < cells_ && portal.cells[1] < cells_);
        SIGHTLINE_DEBUG_ASSERT(portal.count >= 3 && size_t{portal.first} + portal.count <= graph.points.size());
        for (uint32_t side = 0; side < waysOf(portal); ++side, ++ways) ++first_[portal.cells[side] + 1];
    }
    for (uint32_t cell = 0; cell < cells_; ++cell) first_[cell + 1] += first_[cell];
    directed_.resize(ways);
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& from = graph.portals[i];
        for (uint32_t side = 0; side < waysOf(from); ++side) {
            DirectedPortal& portal = directed_[next[from.cells[side]]++];
            portal.plane = side == 0 ? from.plane : -from.plane;
            portal.count = from.count;
            portal.to = from.cells[1 - side];
            portal.portal = i;
            portal.door = from.door;
            portal.thickness = roundUp(from.thickness);
        }
    }
    // Each cell has corners of its own, so that a walk reads them in order.
    for (DirectedPortal& portal : directed_) {
        portal.first = static_cast<uint32_t>(x_.size());
        const auto outline = graph.outline(graph.portals[portal.portal]);
        for (size_t i = 0; i < (outline.size() + 3) / 4 * 4; ++i) {
            const glm::dvec3& point = outline[std::min(i, outline.size() - 1)];
            x_.push_back(point.x);
            y_.push_back(point.y);
            z_.push_back(point.z);
        }
    }
}

void PortalGraph::layTree(const CellSpace& space) {
    const LeafTree& tree = space.tree;
    const std::vector<uint32_t> cell_of_leaf = cellsOfLeaves(space);
    parent_of_cell_.assign(cells_, kNoCell);
    std::vector<uint32_t> hangs(cells_, 0);
    const auto childOf = [&](uint32_t child) {
        if ((child & Node::kLeaf) == 0) return child;
        SIGHTLINE_DEBUG_ASSERT((child & ~Node::kLeaf) < cell_of_leaf.size());
        const uint32_t cell = cell_of_leaf[child & ~Node::kLeaf];
        SIGHTLINE_DEBUG_ASSERT(cell == kNoCell || cell < cells_);
        return cell == kNoCell ? Node::kSolid : Node::kLeaf | cell;
    };
    nodes_.resize(tree.nodes.size());
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        nodes_[i].plane = tree.nodes[i].plane;
        for (uint32_t side = 0; side < 2; ++side) {
            const uint32_t child = childOf(tree.nodes[i].child[side]);
            nodes_[i].child[side] = child;
            if ((child & Node::kLeaf) == 0) {
                SIGHTLINE_DEBUG_ASSERT(child != i && child < nodes_.size());
                nodes_[child].parent = i;
            } else if (child != Node::kSolid) {
                parent_of_cell_[child & ~Node::kLeaf] = i;
                ++hangs[child & ~Node::kLeaf];
            }
        }
    }
    root_ = tree.nodes.empty() ? childOf(Node::kLeaf) : 0;
    ordered_ = !nodes_.empty() && std::all_of(hangs.begin(), hangs.end(), [](uint32_t times) { return times <= 1; });
    bounds_ = tree.bounds;
    if (!bounds_.empty()) reach_ = std::max({reach_, farOf(bounds_.min), farOf(bounds_.max)});
}

void PortalGraph::layRegions(const CellSpace& space) {
    regions_.assign(space.regions.begin(), space.regions.end());
    planes_.assign(space.planes.begin(), space.planes.end());
    for (uint32_t i = 0; i < regions_.size(); ++i) {
        if (i == outside_ || regions_[i].bounds.empty()) continue;
        order_.push_back(i);
        reach_ = std::max({reach_, farOf(regions_[i].bounds.min), farOf(regions_[i].bounds.max)});
    }
    if (order_.empty()) return;
    boxes_.push_back({});
    splitBoxes(0, 0, static_cast<uint32_t>(order_.size()));
}

void PortalGraph::splitBoxes(uint32_t node, uint32_t first, uint32_t count) {
    constexpr uint32_t kFew = 4;
    SIGHTLINE_DEBUG_ASSERT(node < boxes_.size() && count > 0 && size_t{first} + count <= order_.size());
    Box3d box, middles;
    for (uint32_t i = first; i < first + count; ++i) {
        box.grow(regions_[order_[i]].bounds);
        middles.grow(regions_[order_[i]].bounds.center());
    }
    boxes_[node].box = box;
    if (count <= kFew) {
        boxes_[node].first = first;
        boxes_[node].count = count;
        return;
    }
    const glm::dvec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](uint32_t a, uint32_t b) {
                         const double at_a = regions_[a].bounds.center()[axis],
                                      at_b = regions_[b].bounds.center()[axis];
                         return at_a != at_b ? at_a < at_b : a < b;
                     });
    const uint32_t children = static_cast<uint32_t>(boxes_.size());
    boxes_.resize(children + 2);
    boxes_[node].first = children;
    boxes_[node].count = 0;
    splitBoxes(children, first, half);
    splitBoxes(children + 1, first + half, count - half);
}

}  // namespace sightline
