// How marked cells are checked against the walls, and what is found odd about them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

struct SceneCellSettings {
    /// How far a marked cell's face, and a portal, may be from the wall that is meant.  [world units] [>= 0]
    double wall_tolerance = 0.15;
    /// Slits in a wall that are narrower than this are no holes. Negative: 2^-13 of `wall_tolerance`, two hundredths of a
    /// millimetre of its default.  [world units]
    double slit = -1;
    /// Polygons within this of a plane lie in it, for walls are never quite flat; what is seen between two of them
    /// through a gap that is no wider, as at the corners of a room, is no hole. Negative: 2^-11 of `wall_tolerance`.
    /// [world units]
    double bend = -1;
    /// Takes cells and portals as they are marked, without a look at the walls. For procedural scenes.
    bool trusted = false;
    /// Objects that may be elsewhere at run time: they hide nothing, as the leaves of doors.  [Scene::objects]
    std::vector<uint32_t> movable;
    /// Convex pieces of the holes that one face keeps apart; more become their hull.  [limit: >= 1]
    uint32_t most_holes = 32;
};

enum class CellFindingKind : uint8_t {
    kHole,     ///< a wall has a hole that nobody marked: now it is a portal, from `cells[0]` to `cells[1]`
    kNoCell,   ///< a marked shape is no convex solid: its space is outside
    kOverlap,  ///< two cells share space: an eye there is in both
    /// A portal does not lie on its cells, or they are not known: it is left out, and its hole is found as those that
    /// nobody marked.
    kStrayPortal,
    kBentPortal,  ///< a portal is not flat: its hull as seen along its normal is taken
    kStrayDoor,   ///< a portal's door is not there, or does not stand in it: the portal is always open
};
constexpr const char* kCellFindingNames[] = {"hole", "no cell", "overlap", "stray portal", "bent portal", "stray door"};

/// What is odd about a scene's cells, and where.
struct CellFinding {
    CellFindingKind kind = CellFindingKind::kHole;
    uint32_t cells[2] = {CellGraph::kNoCell, CellGraph::kNoCell};  ///< of the CellSpace; kNoCell: none
    uint32_t portal = ScenePortal::kNone;                          ///< of the scene
    glm::dvec3 place{0.0};                                         ///< its middle, in the world
    double size =
        0;  ///< of holes and overlaps area and volume; of the others how far off  [world units, to their power]
    std::string text;  ///< one line
};

struct SceneCellReport {
    std::vector<CellFinding> findings;
    uint64_t holes = 0, no_cells = 0, overlaps = 0, stray_portals = 0, bent_portals = 0, stray_doors = 0;
    double hole_area = 0;         ///< of all holes  [world units^2]
    uint64_t faces = 0;           ///< of cells
    uint64_t moved_faces = 0;     ///< to the wall that was meant
    uint64_t passages = 0;        ///< cells that were added where a portal goes through a wall's thickness
    uint64_t merged_faces = 0;    ///< whose holes became their hull
    double slit = 0, bend = 0;    ///< as used in the cell with the widest  [world units]
    bool outside = false;         ///< some hole leads there
    std::vector<uint32_t> walls;  ///< objects that the answer rests on: while they stand, are drawn and are opaque it
                                  ///< holds  [Scene::objects] rising
};

struct SceneCells {
    /// The scene's cells in their order, then passages, then the outside if there is one.
    CellSpace space;
    SceneCellReport report;
};

}  // namespace sightline::bake
