// A tree over boxes, built by halving: enough to find what a ray or a frustum may meet.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/math/box.h"

namespace sightline::tools {

/// Finds boxes by a test that holds for a box whenever it holds for a part of it.
class BoxTree {
public:
    /// Boxes that are not finite are left out.
    void build(std::span<const Box3d> boxes);

    /// Calls visit(index) for each box in the leaves that touches(box of the leaf) accepts.
    template <class Touches, class Visit>
    void walk(Touches&& touches, Visit&& visit) const {
        if (nodes_.empty()) return;
        uint32_t stack[64];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!touches(node.box)) continue;
            if (node.right == 0) {
                for (uint32_t i = node.begin; i < node.end; ++i) visit(order_[i]);
                continue;
            }
            stack[depth++] = node.right;
            stack[depth++] = static_cast<uint32_t>(&node - nodes_.data()) + 1;
        }
    }

private:
    struct Node {
        Box3d box;
        uint32_t begin = 0, end = 0;
        uint32_t right = 0;  ///< 0: a leaf; the left child is the next node
    };
    void split(std::span<const Box3d> boxes, uint32_t begin, uint32_t end);

    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
};

}  // namespace sightline::tools
