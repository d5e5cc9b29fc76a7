// A bounding volume hierarchy of eight-wide nodes over boxes that stay where they are.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
// Ingo Wald, Carsten Benthin, Solomon Boulos. Getting Rid of Packets. 2008.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/math/box.h"
#include "sightline/tree/bvh_node.h"

namespace sightline {

/// Items are boxes in float around a double origin: an item's true box is inside origin + box.
struct Bvh {
    glm::dvec3 origin{0.0};
    Array<BvhNode> nodes;   ///< the root is nodes[0]; empty if there are no items
    Array<uint32_t> order;  ///< place to item

    explicit Bvh(Memory* memory = defaultMemory()) : nodes(memory), order(memory) {}
};

/// The box relative to an origin, rounded outward.
Box3f roundOutward(const Box3d& box, const glm::dvec3& origin);

/// Builds by binned surface area heuristic. O(n log n); deterministic.
/// @param boxes   world space, finite and not empty
/// @param memory  for the hierarchy and for what building it needs
Bvh buildBvh(std::span<const Box3d> boxes, Memory* memory = defaultMemory());

}  // namespace sightline
