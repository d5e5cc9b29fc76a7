// A bounding volume hierarchy of eight-wide nodes over boxes that move now and then.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
// Ingo Wald, Carsten Benthin, Solomon Boulos. Getting Rid of Packets. 2008.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
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

/// Items are boxes in float around a double origin: an item's true box is inside origin + box.
struct Bvh {
    glm::dvec3 origin{0.0};
    Array<BvhNode> nodes;    ///< the root is nodes[0]; empty if there are no items
    Array<uint32_t> order;   ///< place to item
    Array<uint32_t> parent;  ///< per node: parent's index * 8 + slot; the root's is ~0
    Array<uint32_t> slot;    ///< per item: node's index * 8 + slot
    double built_cost = 0;   ///< surface cost when built, for deciding when to build anew

    explicit Bvh(Memory* memory = defaultMemory()) : nodes(memory), order(memory), parent(memory), slot(memory) {}
};

/// The box relative to an origin, rounded outward.
Box3f roundOutward(const Box3d& box, const glm::dvec3& origin);

/// Builds by binned surface area heuristic. O(n log n); deterministic.
/// @param boxes   world space, finite and not empty
/// @param memory  for the hierarchy and for what building it needs
Bvh buildBvh(std::span<const Box3d> boxes, Memory* memory = defaultMemory());

/// Gives one item a new box and mends the bounds above it. O(depth).
void refit(Bvh& bvh, uint32_t item, const Box3d& box);

/// Sum over nodes of surface area times items, relative to the root's; grows as refits make nodes overlap.
double surfaceCost(const Bvh& bvh);

}  // namespace sightline
