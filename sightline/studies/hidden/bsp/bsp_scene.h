// The triangles of a draw list in a BSP tree, which can be kept from frame to frame while some of them move.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/bsp/bsp.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline::studies {

/// Pieces are numbered by their surfaces.
struct BspScene {
    BspTree tree;
    BspOverlay overlay;
    std::vector<uint8_t> moves;  ///< per item of the list: 1 if it is in the overlay [size: items, or empty]
};

/// All triangles that write depth, of the items that do not move, as they are placed now.
/// @param moves  per item: not 0 if moveItems() shall place it  [size: items, or empty for none]
BspScene buildBspScene(const DrawList& list, std::span<const uint8_t> moves = {}, const BspSettings& settings = {});

/// Places the items that move as their transforms say now; the tree stays as it is.
void moveItems(BspScene& scene, const DrawList& list);

}  // namespace sightline::studies
