// Which cells the objects of a scene lie in: by their triangles, with room to spare.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sightline/base/jobs.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/visfile/object_section.h"

namespace sightline::bake {
using namespace tools;

struct ObjectCellSettings {
    /// A triangle within this distance of a cell is in the cell; at least the space's tolerance.  [world units] [>= 0]
    double margin = 0;
    /// Per object true: it moves, and is not placed.  [size: Scene::objects, or 0: none does]
    std::vector<bool> moves;
    std::vector<uint32_t> walls;  ///< ObjectPlaces::wall  [Scene::objects]
    Jobs* jobs = nullptr;         ///< threads to share the objects out to; the answer is the same with any
    std::function<void(size_t, size_t)> progress;  ///< called with (done, total) objects now and then; may be empty
};

struct ObjectCells {
    ObjectPlaces places;
    std::vector<uint32_t> object_of;  ///< per place the scene's object
    std::vector<Box3d> pieces;        ///< per entry of places.cells: it holds what of the object is in the cell

    uint64_t everywhere = 0;  ///< in no cell, so that they are seen from everywhere
    uint64_t outside = 0;     ///< in the outside, perhaps in cells too
    uint64_t by_box = 0;      ///< deforming, or without triangles: in all cells that their bounds meet
    uint64_t moving = 0;      ///< left out: they move
    uint64_t unbounded = 0;   ///< left out: their bounds are empty or not finite
};

/// The cells of each object that stands still: all that one of its triangles meets or comes as close to as the margin,
/// with what rounding may move; at sharp edges of a cell it may come in from farther away. A triangle in a plane
/// between two cells is in both. What reaches beyond the bounds of a tree is seen from everywhere. Where there is an outside, an object that is not wholly inside of cells, by more than
/// the margin, triangle for triangle, is outside too; where there is none, what is in no cell is seen from everywhere.
///
/// Bounds are transformBox() of the mesh's, as a world has them. O(triangles * cells that their object's bounds meet),
/// of a tree O(triangles * depth + places).
/// @param space  finite
ObjectCells cellsOfObjects(const Scene& scene, const CellSpace& space, const ObjectCellSettings& settings = {});

}  // namespace sightline::bake
