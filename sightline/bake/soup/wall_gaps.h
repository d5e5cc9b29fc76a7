// Walls that nearly touch: the slits between them, which were probably meant to be shut.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/bake/soup/soup_report.h"
#include "sightline/bake/soup/soup_walls.h"

namespace sightline::bake {

/// The gaps among the portals of a scene's own walls: stretches of a portal that are wider than `hole` and at least three times
/// as long as wide, where nothing covers the middle, a surface ends at either side, both of the same objects all along, and one of these surfaces
/// lies in the portal's plane. None is where the nearest surface across that plane shows its back, or is one object's of two sides
/// at both sides: that is the inside of a solid, as of a door's leaf. Stretches in line that the same objects bound are one gap. 64
/// places are looked at along a portal. All of this decides what is listed, and nothing else.
///
/// O(portals + thin portals * log triangles + slits of the same objects squared).
/// @param walls   whose faces the portals were left over from
/// @param space   the cells, with SoupCellReport::smallest_hole already added to their portals
/// @param hole    SoupCellReport::smallest_hole
/// @param widest  wider ones are doorways, not gaps  [world units]
/// @returns the largest first, by width times length
std::vector<WallGap> gapsOfWalls(const SoupWalls& walls, const CellSpace& space, double hole, double widest);

}  // namespace sightline::bake
