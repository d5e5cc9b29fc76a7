// Where a player stands in a compiled map, and which of its leaves are seen from there: many segments.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/cells/cell_space.h"
#include "sightline/cells/portals.h"
#include "sightline/geom/view.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/truth/tree_rays.h"

namespace sightline::bench {
using namespace tools;

/// A map of the Quake family as cells: each open leaf is one; water is a wall, as the maps' own rows have it.
struct MapOfLeaves {
    QuakeMapFile map;
    CellSpace space;
    std::vector<Box3d> bounds;           ///< of each cell: of its leaf's region  [size: cells]
    std::vector<uint32_t> leaf_of_cell;  ///< [size: cells]
};

/// @returns false if the file is not there, or is none
bool readMapOfLeaves(const std::string& path, MapOfLeaves& cells);

/// Eyes at a player's height above a floor, 16 units from walls, with views of 90 degrees that look about level.
std::vector<View> playerViews(const MapOfLeaves& cells, const TreeRays& rays, uint32_t count, uint64_t seed);

/// Which cells a view truly sees, as far as segments find out: over the whole image, and then, until few are found,
/// through the windows of cells that may be seen.
/// @param may  an answer that holds all that is seen
std::vector<bool> trulySeen(const MapOfLeaves& cells, const TreeRays& rays, const View& view, const PortalFlood& may,
                            uint32_t segments, Random& random);

}  // namespace sightline::bench
