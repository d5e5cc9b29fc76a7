// A node of eight children, and what all hierarchies do with it: write slots, read them, and join their boxes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "sightline/base/assert.h"
#include "sightline/math/box.h"

namespace sightline {

/// Eight children side by side, so that one instruction tests them all. An unused slot is an inverted box.
struct alignas(64) BvhNode {
    static constexpr uint32_t kLeaf = 1u << 31;  ///< the child is one item: the other bits are its place in order
    float min[3][8];
    float max[3][8];
    uint32_t child[8];  ///< a node's index, or kLeaf | place
    uint32_t first[8];  ///< the places of all items below the child: first ... first + count - 1
    uint32_t count[8];  ///< 0: the slot is unused
    uint32_t empty[8];  ///< of these places, those whose items have left: PlacedBvh alone has such
};

/// BvhNode::child of an unused slot; no item has that number.
inline constexpr uint32_t kUnusedChild = ~0u;

/// Half the surface of a box; none if it is empty.
inline float halfArea(const Box3f& box) {
    if (box.empty()) return 0.0f;
    const glm::vec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

inline void setSlot(BvhNode& node, int slot, const Box3f& box) {
    SIGHTLINE_DEBUG_ASSERT(slot >= 0 && slot < 8);
    for (int axis = 0; axis < 3; ++axis) {
        node.min[axis][slot] = box.min[axis];
        node.max[axis][slot] = box.max[axis];
    }
}

inline Box3f slotBox(const BvhNode& node, int slot) {
    SIGHTLINE_DEBUG_ASSERT(slot >= 0 && slot < 8);
    Box3f box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = node.min[axis][slot];
        box.max[axis] = node.max[axis][slot];
    }
    return box;
}

/// Makes a slot an inverted box that nothing is below.
inline void clearSlot(BvhNode& node, int slot) {
    setSlot(node, slot, Box3f());
    node.child[slot] = kUnusedChild;
    node.first[slot] = node.count[slot] = node.empty[slot] = 0;
}

inline BvhNode emptyNode() {
    BvhNode node{};
    for (int slot = 0; slot < 8; ++slot) clearSlot(node, slot);
    return node;
}

/// The box around all slots. An unused one is inverted, and adds nothing.
inline Box3f boundsOf(const BvhNode& node) {
    Box3f box;
    for (int axis = 0; axis < 3; ++axis) {
        float low = node.min[axis][0], high = node.max[axis][0];
        for (int slot = 1; slot < 8; ++slot) {
            low = std::min(low, node.min[axis][slot]);
            high = std::max(high, node.max[axis][slot]);
        }
        box.min[axis] = low;
        box.max[axis] = high;
    }
    return box;
}

}  // namespace sightline
