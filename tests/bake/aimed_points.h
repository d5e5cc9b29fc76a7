// Points in boxes and at the edges of portals, where walls and holes meet, and the leaf that a point is in.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/cells/cells.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"

namespace sightline::test {

inline glm::dvec3 pointIn(const Box3d& box, Random& random) {
    glm::dvec3 point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = random.uniform(box.min[axis], box.max[axis]);
    return point;
}

inline bool contains(const Box3d& box, const glm::dvec3& point) {
    return glm::all(glm::lessThanEqual(box.min, point)) && glm::all(glm::lessThanEqual(point, box.max));
}

inline uint32_t leafOf(const LeafTree& tree, const glm::dvec3& point) {
    uint32_t at = tree.nodes.empty() ? LeafTreeNode::kLeaf : 0;
    while ((at & LeafTreeNode::kLeaf) == 0) {
        const LeafTreeNode& node = tree.nodes[at];
        at = node.child[glm::dot(glm::dvec3(node.plane), point) + node.plane.w >= 0];
    }
    return at & ~LeafTreeNode::kLeaf;
}

/// @pre the graph has a portal
inline glm::dvec3 pointAtPortal(const CellGraph& graph, Random& random) {
    const auto outline = graph.outline(graph.portals[random.below(graph.portals.size())]);
    const size_t i = random.below(outline.size());
    const double off = std::pow(10, random.uniform(-7, 0)) * (random.below(2) ? 1 : -1);
    return glm::mix(outline[i], outline[(i + 1) % outline.size()], random.uniform()) +
           off * (outline[(i + 2) % outline.size()] - outline[i]);
}

}  // namespace sightline::test
