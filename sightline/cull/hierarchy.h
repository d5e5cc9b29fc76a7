// Keeps the items of a living hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/frustum.h"
#include "sightline/space/dynamic_bvh.h"

namespace sightline {

/// What a query of a hierarchy did.
struct HierarchyStats {
    uint64_t nodes = 0;         ///< whose children were tested
    uint64_t plane_tests = 0;   ///< of eight children against one plane
    uint64_t inside_nodes = 0;  ///< whose items were all kept without a test
};

/// Frusta that one walk asks at most.
inline constexpr uint32_t kMostFrusta = 32;

/// What a query needs and does not give back; one for each thread. Once it has seen its hierarchies, queries take no
/// memory.
struct HierarchyScratch {
    struct Visit {
        uint32_t node = 0;
        uint32_t planes = 0;  ///< bit per plane that the node is not inside of
    };
    /// The same of several frusta.
    struct ManyVisit {
        uint32_t node = 0;
        uint32_t live = 0;            ///< bit per frustum that the node may touch
        uint32_t crossing = 0;        ///< of these: it is not inside of the frustum
        uint8_t planes[kMostFrusta];  ///< of each that it crosses
    };
    Array<Visit> visits;
    Array<ManyVisit> many_visits;
    explicit HierarchyScratch(Memory* memory = defaultMemory()) : visits(memory), many_visits(memory) {}
};

/// Writes the numbers of the items whose stored boxes may touch the frustum, and of all that are unbounded, and returns
/// how many. The order hangs on the tree alone. The set is that of cullFrustum() over the stored boxes, to the bit: what
/// is outside a plane has a parent that rounding puts no farther outside, and what is inside one likewise.
/// @param kept  [size: >= tree.count + 8]
size_t cullHierarchy(const Frustum& frustum, const LivingBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                     HierarchyStats* stats = nullptr);

/// The same for several frusta in one walk (the eyes of a headset, cascades, the faces of a cube): writes what any of them
/// may touch, once, with a bit per frustum. Of each frustum these are the items that the walk for it alone keeps, to the
/// bit and in its order; a node that only some may touch costs the others nothing. Of unbounded items all bits are set.
/// @param frusta  [size: 1 to kMostFrusta]
/// @param kept    [size: >= tree.count + 8]
/// @param masks   per kept item: bit i of frusta[i]  [size: as kept]
/// @param stats   plane tests of all frusta together
size_t cullHierarchy(std::span<const Frustum> frusta, const LivingBvh& tree, HierarchyScratch& scratch,
                     std::span<uint32_t> kept, std::span<uint32_t> masks, HierarchyStats* stats = nullptr);

}  // namespace sightline
