// Walls that nearly touch: the slits between them, which were probably meant to be shut.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/bake/soup/soup_report.h"
#include "sightline/bake/soup/soup_walls.h"

namespace sightline::bake {

/// The gaps among the portals of a scene's own walls. A portal is a slit if it is wider than `hole`, at least three times as long as
/// it is wide, and if in most of five places along it nothing covers its middle, a surface ends at either side, and one of
/// these surfaces lies in the portal's plane. It is none where the nearest surface across that plane shows its back, or is one
/// object's of two sides at both sides: that is the inside of a solid, as of a door's leaf. Slits that lie in line and are bounded by
/// the same objects are one gap. All of this decides what is listed, and nothing else.
///
/// O(portals + slits * log triangles + slits of the same objects squared).
/// @param walls   whose faces the portals were left over from
/// @param space   the cells, with SoupCellReport::smallest_hole already added to their portals
/// @param hole    SoupCellReport::smallest_hole
/// @param widest  wider ones are doorways, not gaps  [world units]
/// @returns the largest first, by width times length
std::vector<WallGap> gapsOfWalls(const SoupWalls& walls, const CellSpace& space, double hole, double widest);

}  // namespace sightline::bake
