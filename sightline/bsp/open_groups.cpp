// Leaves of a tree that are open to one another, as groups.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/open_groups.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/box.h"

namespace sightline {
namespace {

constexpr uint32_t kNone = ~0u;

using Outline = std::vector<glm::dvec3>;

double areaOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return 0.5 * glm::length(area);
}

/// A square in a plane that holds all of the plane within a box.
Outline sectionOf(const glm::dvec4& plane, const Box3d& box) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(plane)), center = box.center();
    const glm::dvec3 aside = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const double reach = glm::length(box.size());
    const glm::dvec3 u = reach * glm::normalize(glm::cross(aside, normal)), v = glm::cross(normal, u);
    const glm::dvec3 middle = center - (glm::dot(glm::dvec3(plane), center) + plane.w) * normal;
    return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
}

void cut(Outline& outline, const glm::dvec4& plane) {
    Outline kept;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[i + 1 == outline.size() ? 0 : i + 1];
        const double from = glm::dot(glm::dvec3(plane), a) + plane.w, to = glm::dot(glm::dvec3(plane), b) + plane.w;
        if (from >= 0) kept.push_back(a);
        if ((from >= 0) != (to >= 0)) kept.push_back(a + from / (from - to) * (b - a));
    }
    outline = std::move(kept);
}

class Grouping {
public:
    Grouping(const LeafTree& tree, const CellGraph& graph, const OpenGroupSettings& settings)
        : tree_(tree),
          graph_(graph),
          settings_(settings),
          open_(tree.nodes.size(), 0),
          above_(tree.nodes.size(), kNone) {}

    OpenGroups group() {
        findPlaces();
        sumPortals();
        boundCells();
        bottomUp();
        number();
        return std::move(groups_);
    }

private:
    static constexpr uint32_t kLeaf = LeafTreeNode::kLeaf;

    /// Where each cell's leaf hangs, and how deep nodes lie.
    void findPlaces() {
        depth_.assign(tree_.nodes.size(), 0);
        node_of_cell_.assign(graph_.cells, kNone);
        for (uint32_t node = 0; node < tree_.nodes.size(); ++node)
            for (const uint32_t child : tree_.nodes[node].child) {
                if (child >= kLeaf) {
                    const uint32_t cell = graph_.cell_of_leaf[child - kLeaf];
                    if (cell != CellGraph::kNoCell) node_of_cell_[cell] = node;
                } else {
                    above_[child] = node;
                    depth_[child] = depth_[node] + 1;
                }
            }
    }

    /// A portal lies in the plane of the deepest node that is above both of its cells.
    void sumPortals() {
        for (const CellPortal& portal : graph_.portals) {
            uint32_t a = node_of_cell_[portal.cells[0]], b = node_of_cell_[portal.cells[1]];
            while (a != b) {
                if (a == kNone || b == kNone) break;
                uint32_t& deeper = depth_[a] < depth_[b] ? b : a;
                deeper = above_[deeper];
            }
            if (a == b && a != kNone) open_[a] += areaOf(graph_.outline(portal));
        }
    }

    void boundCells() {
        bounds_.resize(graph_.cells);
        for (const CellPortal& portal : graph_.portals)
            for (const glm::dvec3& point : graph_.outline(portal))
                for (const uint32_t cell : portal.cells) bounds_[cell].grow(point);
    }

    /// What is below a node: nothing, one group, or several.
    struct Below {
        bool any = false, one = true;
        Box3d bounds;
    };

    Below below(uint32_t child) const {
        if (child < kLeaf) return below_[child];
        Below leaf;
        const uint32_t cell = graph_.cell_of_leaf[child - kLeaf];
        if (cell == CellGraph::kNoCell) return leaf;
        leaf.any = true;
        leaf.bounds = bounds_[cell];
        return leaf;
    }

    void bottomUp() {
        below_.resize(tree_.nodes.size());
        const double largest = settings_.largest * glm::length(tree_.bounds.size());
        for (uint32_t node = static_cast<uint32_t>(tree_.nodes.size()); node-- > 0;) {
            const Below behind = below(tree_.nodes[node].child[0]), front = below(tree_.nodes[node].child[1]);
            Below& all = below_[node];
            all.any = behind.any || front.any;
            all.bounds = behind.bounds;
            all.bounds.grow(front.bounds);
            all.one = behind.one && front.one;
            if (all.one && behind.any && front.any)
                all.one = glm::length(all.bounds.size()) <= largest && open_[node] > 0 &&
                          open_[node] >= settings_.openness * sectionArea(node);
        }
    }

    double sectionArea(uint32_t node) const {
        Outline outline = sectionOf(tree_.nodes[node].plane, tree_.bounds);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec4 low(0), high(0);
            low[axis] = 1;
            low.w = -tree_.bounds.min[axis];
            high[axis] = -1;
            high.w = tree_.bounds.max[axis];
            cut(outline, low);
            cut(outline, high);
        }
        for (uint32_t below = node, up = above_[node]; up != kNone; below = up, up = above_[up])
            cut(outline, tree_.nodes[up].child[1] == below ? tree_.nodes[up].plane : -tree_.nodes[up].plane);
        return areaOf(outline);
    }

    /// From the root down: the first node that is one group names all below.
    void number() {
        groups_.group_of_cell.assign(graph_.cells, kNone);
        std::vector<uint32_t> of_node(tree_.nodes.size(), kNone);
        for (uint32_t node = 0; node < tree_.nodes.size(); ++node) {
            uint32_t group = above_[node] == kNone ? kNone : of_node[above_[node]];
            if (group == kNone && below_[node].any && below_[node].one) group = groups_.groups++;
            of_node[node] = group;
        }
        for (uint32_t cell = 0; cell < graph_.cells; ++cell) {
            const uint32_t node = node_of_cell_[cell];
            const uint32_t group = node == kNone ? kNone : of_node[node];
            groups_.group_of_cell[cell] = group == kNone ? groups_.groups++ : group;
        }
    }

    const LeafTree& tree_;
    const CellGraph& graph_;
    const OpenGroupSettings& settings_;
    std::vector<double> open_;             ///< per node: area of the portals in its plane
    std::vector<uint32_t> above_, depth_;  ///< per node
    std::vector<uint32_t> node_of_cell_;
    std::vector<Box3d> bounds_;
    std::vector<Below> below_;
    OpenGroups groups_;
};

}  // namespace

OpenGroups groupOpenCells(const LeafTree& tree, const CellGraph& graph, const OpenGroupSettings& settings) {
    return Grouping(tree, graph, settings).group();
}

}  // namespace sightline
