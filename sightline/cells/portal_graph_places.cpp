// Where bodies stand in a graph of cells: down the tree, or among the regions.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cells/point_body.h"
#include "sightline/cells/portal_graph.h"

namespace sightline {
namespace {

constexpr size_t kMostRegions = 16;  // that together may hold a body

using Node = PortalGraph::Node;

struct Heights {
    double least, most;
};

Heights heightsOf(std::span<const glm::dvec3> points, const glm::dvec4& plane) {
    Heights heights{INFINITY, -INFINITY};
    for (const glm::dvec3& point : points) {
        const double height = glm::dot(glm::dvec3(plane), point) + plane.w;
        heights.least = std::min(heights.least, height);
        heights.most = std::max(heights.most, height);
    }
    return heights;
}

Heights heightsOf(const Box3d& box, const glm::dvec4& plane) {
    Heights heights{plane.w, plane.w};
    for (int axis = 0; axis < 3; ++axis) {
        const double a = plane[axis] * box.min[axis], b = plane[axis] * box.max[axis];
        heights.least += std::min(a, b);
        heights.most += std::max(a, b);
    }
    return heights;
}

Box3d boxOf(std::span<const glm::dvec3> points) {
    Box3d box;
    for (const glm::dvec3& point : points) box.grow(point);
    return box;
}

Box3d grown(Box3d box, double by) {
    box.min -= by;
    box.max += by;
    return box;
}

double largestOf(const Box3d& box) {
    const glm::dvec3 far = glm::max(glm::abs(box.min), glm::abs(box.max));
    return std::max({far.x, far.y, far.z});
}

bool meet(const Box3d& a, const Box3d& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis])) return false;
    return true;
}

bool isWithin(const Box3d& inner, const Box3d& outer) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(inner.min[axis] >= outer.min[axis] && inner.max[axis] <= outer.max[axis])) return false;
    return true;
}

/// Pushes a body down the tree; each leaf gets what planes leave of it.
class TreeDescent {
public:
    /// @param slack  what is within it of a leaf is in the leaf, be it a cell or solid
    TreeDescent(std::span<const Node> nodes, double radius, double slack, Array<uint32_t>& cells)
        : nodes_(nodes), reach_(radius + slack), cells_(cells) {}

    /// @returns false if the body reaches into a solid leaf, or it is cut too often to tell
    bool down(uint32_t child, std::span<const glm::dvec3> points, int depth) {
        PointBody rest, part;
        while ((child & Node::kLeaf) == 0) {
            SIGHTLINE_DEBUG_ASSERT(child < nodes_.size());
            const Node& node = nodes_[child];
            const Heights heights = heightsOf(points, node.plane);
            const bool behind = heights.least <= reach_, front = heights.most >= -reach_;
            if (behind && front) {
                if (depth == kMostCuts || !cutBody(points, -node.plane, -reach_, part)) return false;
                if (!down(node.child[0], part.all(), depth + 1)) return false;
                if (!cutBody(points, node.plane, -reach_, part)) return false;
                rest = part;
                points = rest.all();
            }
            if (!behind && !front) return false;  // not a number
            child = node.child[front ? 1 : 0];
        }
        if (child == Node::kSolid) return false;
        cells_.push_back(child & ~Node::kLeaf);
        return true;
    }

private:
    static constexpr int kMostCuts = 24;

    std::span<const Node> nodes_;
    double reach_;
    Array<uint32_t>& cells_;
};

void sortOnce(Array<uint32_t>& cells) {
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

}  // namespace

template <class Visit>
void PortalGraph::visitRegions(const Box3d& box, Visit visit) const {
    if (boxes_.empty()) return;
    uint32_t stack[64];
    uint32_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
        const BoxNode& node = boxes_[stack[--open]];
        if (!meet(node.box, box)) continue;
        if (node.count == 0) {
            SIGHTLINE_DEBUG_ASSERT(open + 2 <= std::size(stack) && size_t{node.first} + 1 < boxes_.size());
            stack[open++] = node.first + 1;
            stack[open++] = node.first;
            continue;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
            if (meet(regions_[order_[i]].bounds, box)) visit(order_[i]);
    }
}

bool PortalGraph::cellsAround(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const {
    cells.clear();
    if (points.empty() || points.size() > PointBody::kMost || !(radius >= 0) || !std::isfinite(radius)) return false;
    for (const glm::dvec3& point : points)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(point[axis])) return false;
    const bool known = of_tree_ ? cellsOfTree(points, radius, cells) : cellsOfRegions(points, radius, cells);
    sortOnce(cells);
    return known && !cells.empty();
}

bool PortalGraph::cellsOfTree(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const {
    if (!bounds_.empty() && !isWithin(grown(boxOf(points), radius), grown(bounds_, tolerance_))) return false;
    if (root_ == Node::kSolid) return false;
    return TreeDescent(nodes_, radius, tolerance_, cells).down(root_, points, 0);
}

bool PortalGraph::isCovered(std::span<const glm::dvec3> points, std::span<const uint32_t> regions) const {
    if (points.empty()) return true;
    if (regions.empty()) return false;
    SIGHTLINE_DEBUG_ASSERT(regions[0] < regions_.size());
    const CellRegion& region = regions_[regions[0]];
    // How far apart a plane that two regions share may be from region to region: by the points' coordinates, and by the
    // distance of the plane, which is known to a few roundings of 2^-53 of the region's. Not by what lies elsewhere.
    const double apart = 0x1p-40 * largestOf(boxOf(points)) + 0x1p-50 * largestOf(region.bounds);
    const double rounding = std::min(tolerance_, apart);
    PointBody rest, part;
    for (uint32_t i = region.first_plane; i < region.first_plane + region.plane_count; ++i) {
        if (heightsOf(points, planes_[i]).least >= -rounding) continue;
        if (!cutBody(points, -planes_[i], rounding, part) || !isCovered(part.all(), regions.subspan(1))) return false;
        if (!cutBody(points, planes_[i], -rounding, part)) return false;
        rest = part;
        points = rest.all();
        if (points.empty()) return true;
    }
    return true;
}

bool PortalGraph::cellsOfRegions(std::span<const glm::dvec3> points, double radius, Array<uint32_t>& cells) const {
    // Around each point the cube that holds the ball. A wall may stand in a cell as far as the tolerance, and behind it
    // the backs of its faces hide nothing: so what comes as close to the end of all cells is in a wall, perhaps.
    const double reach = radius + tolerance_;
    PointBody wide;
    if (8 * points.size() > PointBody::kMost) return false;
    for (const glm::dvec3& point : points)
        for (int corner = 0; corner < 8; ++corner)
            wide.points[wide.count++] =
                point + reach * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    bool within_one = false;
    visitRegions(boxOf(wide.all()), [&](uint32_t i) {
        const CellRegion& region = regions_[i];
        PointBody body, part;
        std::span<const glm::dvec3> left = points;
        bool whole = true;
        for (uint32_t p = region.first_plane; p < region.first_plane + region.plane_count; ++p) {
            const Heights heights = heightsOf(left, planes_[p]);
            whole &= heights.least >= reach;
            if (heights.least >= -reach) continue;
            if (!(heights.most >= -reach)) return;
            if (!cutBody(left, planes_[p], -reach, part)) break;
            body = part;
            left = body.all();
        }
        within_one |= whole;
        cells.push_back(i);
    });
    if (within_one || (cells.size() <= kMostRegions && isCovered(wide.all(), cells))) return true;
    if (outside_ == kNoCell) return false;
    cells.push_back(outside_);
    return true;
}

bool PortalGraph::cellsOf(const Box3d& box, Array<uint32_t>& cells) const {
    cells.clear();
    if (box.empty()) return false;
    const Box3d wide = grown(box, tolerance_);
    if (of_tree_) {
        struct Part {
            uint32_t child;
            Box3d box;
        };
        Array<Part> open(cells.memory());
        if (root_ != Node::kSolid) open.push_back({root_, wide});
        while (!open.empty()) {
            const Part part = open.back();
            open.pop_back();
            if ((part.child & Node::kLeaf) != 0) {
                if (part.child != Node::kSolid) cells.push_back(part.child & ~Node::kLeaf);
                continue;
            }
            const Node& node = nodes_[part.child];
            const Heights heights = heightsOf(part.box, node.plane);
            if (!(heights.least > tolerance_)) open.push_back({node.child[0], part.box});
            if (!(heights.most < -tolerance_)) open.push_back({node.child[1], part.box});
        }
        // A sight line to what lies beyond the bounds leaves them, and beyond them there are no portals.
        if (!bounds_.empty() && !isWithin(box, grown(bounds_, tolerance_))) cells.clear();
    } else {
        visitRegions(wide, [&](uint32_t i) {
            const CellRegion& region = regions_[i];
            for (uint32_t p = region.first_plane; p < region.first_plane + region.plane_count; ++p)
                if (heightsOf(box, planes_[p]).most < -tolerance_) return;
            cells.push_back(i);
        });
        if (outside_ != kNoCell) {
            glm::dvec3 corners[8];
            for (int corner = 0; corner < 8; ++corner)
                corners[corner] = {corner & 1 ? wide.max.x : wide.min.x, corner & 2 ? wide.max.y : wide.min.y,
                                   corner & 4 ? wide.max.z : wide.min.z};
            if (cells.size() > kMostRegions || !isCovered(corners, cells)) cells.push_back(outside_);
        }
    }
    sortOnce(cells);
    return !cells.empty();
}

}  // namespace sightline
