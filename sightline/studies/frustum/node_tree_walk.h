// Keeps the items of a scene's own hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
//
// James Clark. Hierarchical Geometric Models for Visible Surface Algorithms. 1976.
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/cull/hierarchy.h"
#include "sightline/studies/frustum/node_tree.h"

namespace sightline::studies {

/// Writes the numbers of the items whose stored boxes may touch the frustum, and of all that are without end, and returns
/// how many. The order hangs on the tree alone. The set is that of cullFrustum() over the stored boxes, to the bit.
/// @param kept   [size: >= tree.order.size() + 8]
/// @param stats  HierarchyStats::nodes counts blocks of eight children
size_t cullNodeTree(const Frustum& frustum, const NodeTreeBounds& tree, HierarchyScratch& scratch,
                    std::span<uint32_t> kept, HierarchyStats* stats = nullptr);

}  // namespace sightline::studies
