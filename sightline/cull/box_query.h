// The items whose boxes overlap a box: what a light reaches, what a blast hits, what a region of a map holds.
// SPDX-License-Identifier: MIT
//
// Antonin Guttman. R-Trees: A Dynamic Index Structure for Spatial Searching. 1984.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/cull/frustum.h"
#include "sightline/cull/hierarchy.h"

namespace sightline {

/// Writes the numbers of the items whose stored boxes overlap the box, and returns how many. Touching counts. The box is
/// rounded outward to float around the tree's or the list's origin, so that no item is left out whose own box overlaps it;
/// the set is the same for both over the same stored boxes and origin, on every machine. A bound that is infinite
/// leaves that side open; so does one that is NaN. A box that is empty (min > max on some axis) overlaps nothing.
///
/// `nodes` counts the nodes whose children were compared with the box; there are no plane tests.
/// @param box   world space
/// @param kept  [size: >= tree.size() + 8]; the order hangs on the tree and the box alone
size_t queryBox(const Box3d& box, const PlacedBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                HierarchyStats* stats = nullptr);
/// As above, over a flat list, in rising order.
/// @param kept  [size: >= count rounded up to 16]
size_t queryBox(const Box3d& box, const BoxArrays& boxes, std::span<uint32_t> kept);

}  // namespace sightline
