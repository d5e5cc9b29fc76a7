// A procedural building: rooms, corridors, doors, windows, stairs and furniture, with its cells and portals.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Builds an office building on its plot, deterministic in (seed, floors). Metres, y up, the ground at y = 0, the
/// origin in the middle of the building. What is built is one closed surface in the world's own coordinates, cut into
/// objects by room and direction; furniture is instanced. Every object hangs in a tree of nodes, floor and
/// room: "Floor 3/Office 3.07/Desk 2".
///
/// Cells are boxes of air: one for each room, each doorway and window recess, each storey of the stairs and of the
/// lift's shaft, the terrace on the roof, and five around the building (four sides, and above) that reach as far as
/// the plot. Their interiors are disjoint, and all of the plot that is not solid lies in one. A room's cell is called
/// after its node; those of its doorways and windows begin with that name.
///
/// Portals are all the rectangles in which two cells touch: from one cell into another there is no other way.
/// `ScenePortal::door` names the leaf that hangs in the portal's plane, shut or not: shut, it covers the whole
/// portal. Leaves of glass are not named. Names say how each leaf stands: "Door (shut)", "(half open)", "(open)".
/// @param floors  [limit: 1 to 200]
Scene makeBuilding(uint64_t seed, uint32_t floors);

}  // namespace sightline::tools
