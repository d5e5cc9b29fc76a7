// The convex cells that a BSP tree's leaves are: where a point lies, which planes bound a cell, what its walls look like.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/bsp_cells.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/bsp/bsp_piece.h"

namespace sightline {
namespace {

/// A plane whose inside is where the cell lies, and where it comes from.
struct Half {
    glm::dvec4 plane{0.0};
    uint32_t node = BspWall::kBox;
};

/// A square in a plane, counter-clockwise seen from the plane's front, that reaches beyond a box.
std::vector<glm::dvec3> squareIn(const glm::dvec4& plane, const Box3d& box) {
    const glm::dvec3 n(plane);
    const glm::dvec3 size = glm::abs(n);
    const int axis = size.x < size.y ? (size.x < size.z ? 0 : 2) : (size.y < size.z ? 1 : 2);
    glm::dvec3 helper(0.0);
    helper[axis] = 1;
    const double reach = 2 * glm::length(box.size());
    const glm::dvec3 u = reach * glm::normalize(glm::cross(helper, n));
    const glm::dvec3 v = glm::cross(n, u);
    const glm::dvec3 middle = box.center() - n * distanceTo(plane, box.center());
    return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
}

/// What of an outline lies in front of a plane.
std::vector<glm::dvec3> keepFront(const std::vector<glm::dvec3>& outline, const glm::dvec4& plane, double thickness) {
    const BspReach reach = reachOf(outline, plane, thickness);
    if (!reach.back) return outline;
    BspOutline back, front;
    if (reach.front) splitPolygon(outline, plane, thickness, 0, back, front);
    return front.points;
}

std::vector<Half> halvesOf(const BspTree& tree, uint32_t leaf, const Box3d& box) {
    std::vector<Half> halves;
    for (const BspBound& bound : boundsOfLeaf(tree, leaf)) {
        const glm::dvec4& plane = tree.nodes[bound.node].plane;
        halves.push_back({bound.side == kBspFront ? plane : -plane, bound.node});
    }
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 plane(0.0);
        plane[axis] = 1;
        plane.w = -box.min[axis];
        halves.push_back({plane, BspWall::kBox});
        plane[axis] = -1;
        plane.w = box.max[axis];
        halves.push_back({plane, BspWall::kBox});
    }
    return halves;
}

/// Whether a face that came before lies in the same plane: the cell is bounded there once.
bool isDouble(const std::vector<Half>& halves, size_t i, const std::vector<glm::dvec3>& outline, double thickness) {
    for (size_t j = 0; j < i; ++j) {
        const BspReach reach = reachOf(outline, halves[j].plane, thickness);
        if (!reach.back && !reach.front) return true;
    }
    return false;
}

}  // namespace

uint32_t leafOf(const BspTree& tree, const glm::dvec3& point) {
    uint32_t at = tree.root;
    while ((at & BspNode::kLeaf) == 0) {
        const BspNode& node = tree.nodes[at];
        at = node.child[distanceTo(node.plane, point) >= 0 ? kBspFront : kBspBack];
    }
    return at & ~BspNode::kLeaf;
}

std::vector<BspBound> boundsOfLeaf(const BspTree& tree, uint32_t leaf) {
    SIGHTLINE_ASSERT(leaf < tree.leaf.size());
    std::vector<BspBound> bounds;
    for (uint32_t slot = tree.leaf[leaf]; slot != BspNode::kNone; slot = tree.parent[slot >> 1])
        bounds.push_back({slot >> 1, static_cast<BspSide>(slot & 1)});
    std::reverse(bounds.begin(), bounds.end());
    return bounds;
}

std::vector<BspWall> wallsOfLeaf(const BspTree& tree, uint32_t leaf, const Box3d& box) {
    const std::vector<Half> halves = halvesOf(tree, leaf, box);
    // Planes are known as well as the tree and the box are large.
    const double thickness = std::max(tree.thickness, 0x1p-40 * glm::length(box.size()));
    std::vector<BspWall> walls;
    for (size_t i = 0; i < halves.size(); ++i) {
        std::vector<glm::dvec3> outline = squareIn(halves[i].plane, box);
        for (size_t j = 0; j < halves.size() && !outline.empty(); ++j)
            if (j != i) outline = keepFront(outline, halves[j].plane, thickness);
        if (outline.size() < 3 || isDouble(halves, i, outline, thickness)) continue;
        walls.push_back({halves[i].node, std::move(outline)});
    }
    if (walls.size() < 4) walls.clear();
    return walls;
}

double volumeOf(const std::vector<BspWall>& walls) {
    if (walls.empty()) return 0;
    const glm::dvec3 origin = walls[0].outline[0];
    double sum = 0;
    for (const BspWall& wall : walls)
        for (size_t i = 1; i + 1 < wall.outline.size(); ++i)
            sum -=
                glm::dot(wall.outline[0] - origin, glm::cross(wall.outline[i] - origin, wall.outline[i + 1] - origin));
    return sum / 6;
}

}  // namespace sightline
