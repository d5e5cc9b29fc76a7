// From the cells and portals that a scene's maker marked to cells that hold: walls are checked, holes become portals.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/bit_matrix.h"
#include "sightline/scene/scene.h"
#include "sightline/space/cell_space.h"

namespace sightline {

struct SceneCellSettings {
    /// How far a marked cell's face, and a portal, may be from the wall that is meant.  [world units] [>= 0]
    double wall_tolerance = 0.15;
    /// Slits in a wall that are narrower than this are no holes. Negative: 2^-20 of the size of all cells, a hundredth of a
    /// millimetre in a room of ten metres.  [world units]
    double slit = -1;
    /// Polygons within this of a plane lie in it, for walls are never quite flat; what is seen between two of them through a
    /// gap that is no wider, as at the corners of a room, is no hole. Negative: 2^-17 of the size of all cells.
    /// [world units]
    double bend = -1;
    /// Cells and portals are taken as they are marked: no wall is looked at. For makers that know.
    bool trusted = false;
    /// Objects that may be elsewhere at run time: they hide nothing, as the leaves of doors.  [Scene::objects]
    std::vector<uint32_t> movable;
    /// Convex pieces of the holes that one face keeps apart; more become their hull.  [limit: >= 1]
    uint32_t most_holes = 32;
};

enum class CellFindingKind : uint8_t {
    kHole,         ///< a wall has a hole that nobody marked: now it is a portal, from `cells[0]` to `cells[1]`
    kNoCell,       ///< a marked shape is no convex solid: its space is outside
    kOverlap,      ///< two cells share space: an eye there is in both
    kStrayPortal,  ///< a portal does not lie on its cells, or they are not known: it is left out, and its hole is found as
                   ///< those that nobody marked
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
    double slit = 0, bend = 0;    ///< as used  [world units]
    bool outside = false;         ///< some hole leads there
    std::vector<uint32_t> walls;  ///< objects that the answer rests on: while they stand, are drawn and are opaque it
                                  ///< holds  [Scene::objects] rising
};

struct SceneCells {
    /// The scene's cells in their order, then passages, then the outside if there is one.
    CellSpace space;
    SceneCellReport report;
};

/// Rows of cells that have an outside, once they are baked: what sees the outside sees all cells, since from there walls
/// hide nothing that may be drawn from within alone. The outside has no row then, which sees all, too.
/// @param visible  symmetric, of the rows that space.row_of_cell names
/// @returns the rows that see the outside, itself included, rising; none without an outside
std::vector<uint32_t> seeAllFromOutside(CellSpace& space, BitMatrix& visible);

/// Makes cells of the marked ones, so that a sight line which leaves a cell without meeting a drawn, opaque front leaves it
/// by a portal. Holes in walls that nobody marked become portals; docs/techniques/cells.md has the argument.
///
/// Not sound for slits narrower than `slit` and, between the sheets of a wall, `bend`, for trusted cells that are not what they are said to be, and if one of
/// SceneCellReport::walls is moved or hidden.
///
/// A scene without cells gives a space without cells. O(cells * objects + triangles near cells * pieces of their faces).
SceneCells cellsOfScene(const Scene& scene, const SceneCellSettings& settings = {});

}  // namespace sightline
