// Keeps the items of a world's hierarchy that may touch a view frustum, or any of several.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/cull/hierarchy_scratch.h"
#include "sightline/geom/frustum.h"
#include "sightline/tree/world_bvh.h"

namespace sightline {

/// Writes the numbers of the items whose stored boxes may touch the frustum, and returns how many. Their order depends
/// on the tree and the frustum alone. The set is exactly that of cullFrustum() over the stored boxes: rounding never
/// puts a parent farther outside of a plane than its child, nor farther inside.
/// @param kept  [size: >= tree.size() + 8]
size_t cullHierarchy(const Frustum& frustum, const PlacedBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                     HierarchyStats* stats = nullptr);

/// The same for several frusta in one walk (the eyes of a headset, cascades, the faces of a cube). Writes each item
/// that any frustum may touch once, with a bit per frustum. Each frustum has the items that a walk for it alone would
/// keep. A node costs nothing for the frusta that do not touch it.
/// @param frusta  [size: 1 to kMostFrusta]
/// @param kept    [size: >= tree.size() + 8]
/// @param masks   per kept item: bit i of frusta[i]  [size: as kept]
/// @param stats   plane tests of all frusta together
size_t cullHierarchy(std::span<const Frustum> frusta, const PlacedBvh& tree, HierarchyScratch& scratch,
                     std::span<uint32_t> kept, std::span<uint32_t> masks, HierarchyStats* stats = nullptr);

}  // namespace sightline
