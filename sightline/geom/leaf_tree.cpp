// The boxes of a tree's leaves.
// SPDX-License-Identifier: MIT
#include "sightline/geom/leaf_tree.h"

#include <algorithm>
#include <cmath>

namespace sightline {

std::vector<Box3d> leafBoxes(const LeafTree& tree) {
    std::vector<Box3d> boxes(tree.contents.size());
    struct Part {
        uint32_t child;
        Box3d box;
    };
    std::vector<Part> parts{{tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, tree.bounds}};
    while (!parts.empty()) {
        const Part part = parts.back();
        parts.pop_back();
        if (part.box.empty()) continue;
        if (part.child & LeafTreeNode::kLeaf) {
            boxes[part.child & ~LeafTreeNode::kLeaf].grow(part.box);
            continue;
        }
        const LeafTreeNode& node = tree.nodes[part.child];
        Box3d sides[2] = {part.box, part.box};  // behind, in front
        for (int axis = 0; axis < 3; ++axis) {
            const glm::dvec3 normal(node.plane);
            if (normal[axis] == 0 || normal[(axis + 1) % 3] != 0 || normal[(axis + 2) % 3] != 0) continue;
            const double at = -node.plane.w / normal[axis];
            Box3d& above = sides[normal[axis] > 0];
            Box3d& below = sides[normal[axis] < 0];
            above.min[axis] = std::max(above.min[axis], at);
            below.max[axis] = std::min(below.max[axis], at);
        }
        for (const int side : {0, 1}) parts.push_back({node.child[side], sides[side]});
    }
    return boxes;
}

}  // namespace sightline
