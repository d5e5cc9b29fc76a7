// Several frusta in one walk of a world's hierarchy, beside a walk for each.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/table.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::bench {

/// Two eyes, four cascades, the six faces of a cube, from the middle of a world.
/// @param where  names the tree in the rows
/// @param world  half side of the world  [world units]
void measureManyFrusta(Table& table, const PlacedBvh& tree, const std::string& where, double world, int repeat);

}  // namespace sightline::bench
