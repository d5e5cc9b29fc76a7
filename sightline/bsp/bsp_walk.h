// The ways through a BSP tree: back to front and front to back as seen by an eye, or in a direction.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/bsp/bsp_tree.h"

namespace sightline {

/// An eye for the walks: a point, or a point at infinity.
inline glm::dvec4 bspEye(const glm::dvec3& position) { return {position, 1.0}; }
/// @param direction  of a parallel view, into the scene
inline glm::dvec4 bspParallelEye(const glm::dvec3& direction) { return {-direction, 0.0}; }

/// A tree as the walks see it: what is below a child is a node, or a leaf that ends the way.
struct BspStatic {
    const BspTree& tree;

    const BspNode& node(uint32_t i) const { return tree.nodes[i]; }
    uint32_t root() const { return tree.root; }
    uint32_t below(uint32_t child) const { return child; }
    void prefetch([[maybe_unused]] uint32_t child) const {
#if defined(__GNUC__)
        // Leaves have no larger numbers than nodes, but for one: the address stays within the array's end.
        __builtin_prefetch(tree.nodes.data() + (child & ~BspNode::kLeaf));
#endif
    }
};

/// The same with moving things in it.
struct BspOverlaid {
    const BspTree& tree;
    const BspOverlay& overlay;

    const BspNode& node(uint32_t i) const {
        return i < overlay.first_node ? tree.nodes[i] : overlay.nodes[i - overlay.first_node];
    }
    uint32_t root() const { return tree.root; }
    uint32_t below(uint32_t child) const {
        if ((child & BspNode::kLeaf) == 0) return child;
        // An overlay's own leaves are numbered after the tree's.
        const uint32_t leaf = child & ~BspNode::kLeaf;
        return leaf < overlay.root_of_leaf.size() ? overlay.root_of_leaf[leaf] : child;
    }
    void prefetch(uint32_t) const {}
};

/// A node that is to be visited once what lies before it has been gone through, and the child after it.
struct BspStep {
    uint32_t node = 0, after = 0;
};
/// Kept between walks for its memory.
using BspStack = std::vector<BspStep>;

namespace detail {

/// kFirst: the side that is gone through before the node itself, of an eye in front.
template <BspSide kFirst, class Tree, class Enter, class Visit>
void walkBsp(const Tree& tree, const glm::dvec4& eye, BspStack& stack, Enter&& enter, Visit&& visit) {
    stack.clear();
    uint32_t at = tree.below(tree.root());
    for (;;) {
        while ((at & BspNode::kLeaf) == 0 && enter(at)) {
            const BspNode& node = tree.node(at);
            if ((tree.below(node.child[kBspBack]) & tree.below(node.child[kBspFront]) & BspNode::kLeaf) != 0) {
                visit(at);
                break;
            }
            tree.prefetch(node.child[kBspBack]);  // the child in front mostly comes next in memory
            const glm::dvec4& p = node.plane;
            const double distance = p.x * eye.x + p.y * eye.y + (p.z * eye.z + p.w * eye.w);
            const bool side = kFirst == kBspFront ? distance >= 0 : distance < 0;
            const uint32_t before = tree.below(node.child[side]), after = tree.below(node.child[1 - side]);
            if ((before & BspNode::kLeaf) != 0) {
                visit(at);
                at = after;
                continue;
            }
            stack.push_back({at, after});
            at = before;
        }
        if (stack.empty()) return;
        const BspStep step = stack.back();
        stack.pop_back();
        visit(step.node);
        at = step.after;
    }
}

}  // namespace detail

/// Calls visit(node) for the nodes, farthest first: what lies in a node's plane is hidden by nothing that was visited
/// before. Before a node and all below it are gone through, enter(node) is asked; where it says no they are skipped.
/// If the eye lies in a plane, its sides come in either order.
/// @param tree  BspStatic or BspOverlaid
/// @param eye   bspEye() or bspParallelEye()
template <class Tree, class Enter, class Visit>
void walkBackToFront(const Tree& tree, const glm::dvec4& eye, BspStack& stack, Enter&& enter, Visit&& visit) {
    detail::walkBsp<kBspBack>(tree, eye, stack, enter, visit);
}

/// The same, nearest first: the nearer branch, which of an eye behind the plane is the back one; the node; the other.
template <class Tree, class Enter, class Visit>
void walkFrontToBack(const Tree& tree, const glm::dvec4& eye, BspStack& stack, Enter&& enter, Visit&& visit) {
    detail::walkBsp<kBspFront>(tree, eye, stack, enter, visit);
}

}  // namespace sightline
