// What of a map is outside: a flood from beyond its bounds, and the way by which it leaks in.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/cells/cells.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {
using namespace tools;

/// A way from a thing of the map to beyond its bounds, in the open all along.
struct MapLeak {
    uint32_t entity = 0;           ///< index into QuakeMap::entities
    std::string what;              ///< its class
    std::vector<glm::dvec3> path;  ///< from its origin, through the middles of portals, to the bounds
};

struct MapCells {
    CellGraph graph;
    std::vector<MapLeak> leaks;  ///< none, or the shortest one, by the portals on the way
    uint64_t outside = 0;   ///< cells that are reached from beyond the bounds; if nothing leaks they are none any more
    uint64_t standing = 0;  ///< things in the open that were asked whether they are reached
    uint64_t reached = 0;   ///< of them
    uint64_t closed = 0;    ///< portals between the inside and the outside that were too narrow to be a way
};

/// The cells of a tree of brushes without those outside: what is reached from beyond the bounds becomes a wall,
/// unless some thing of the map stands there. Then there is a leak, it is reported with its way, and all cells stay:
/// the outside is a place like any other, and what is inside is hidden from it, or not, as it is. Nothing is lost but
/// sharpness.
///
/// A thing is an entity with an origin and without brushes, in no solid leaf. Three planes that should meet in a line
/// rarely do so in numbers: the sliver between them is a portal, but no way. Such portals are closed only between
/// the inside and the outside; those within are kept. O(portals).
/// @param least_way  portals that are narrower anywhere across are no way for the flood; compilers of the family
///                   leave out those of which not three sides are longer than 0.2, and maps are sealed by that
///                   measure [world units] [>= 0]
MapCells cellsInside(const QuakeMap& map, const BrushTree& brushes, double least_way = 0.25);

/// A way as the engines of the family draw it (`.pts`): a point a line, in the map's own axes.
/// @param step  between points [world units] [> 0]
std::string pointFile(const MapLeak& leak, double step = 8);

}  // namespace sightline::bake
