// View cells: boxes that space is divided into, and which objects may be seen from each, whatever the scene is.
// SPDX-License-Identifier: MIT
//
// Daniel Cohen-Or, Gadi Fibich, Dan Halperin, Eyal Zadicario. Conservative Visibility and Strong Occlusion for
// Viewspace Partitioning of Densely Occluded Scenes. 1998.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sightline/bake/view_cells/row_journal.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

struct ViewCellSettings {
    uint32_t most_cells = 2048;  ///< [limit: >= 2]
    /// No cell is halved if its longest side would be shorter. Negative: a 512th of the core's diagonal (SceneCore).  [world
    /// units]
    double smallest_cell = -1;
    /// Flat parts that are smaller than a square of this side hide nothing from whole cells. Negative: a 512th of the
    /// scene's diagonal.  [world units]
    double smallest_occluder = -1;
    double smallest_hole = -1;  ///< SoupCellSettings::smallest_hole
    /// Places where viewers may be, some for each cell or more: cells are the finer the more of them are near. Rows hold
    /// everywhere all the same. Empty: the finer the more room there is. O(eyes) for each cell.  [world units]
    std::vector<glm::dvec3> eyes;
    /// Nodes of hierarchies that the search for hiders of one cell may open: what is not asked by then is visible.
    uint64_t budget = uint64_t{1} << 22;
    /// Rows that hide less are left out: of the pairs of cells and objects, the share that must be hidden.  [0 to 1]
    double least_hidden = 0.25;
    std::vector<uint32_t> movable;  ///< objects that may be elsewhere at run time: they hide nothing  [Scene::objects]
    Jobs* jobs = nullptr;           ///< threads to share the cells out to; the answer is the same with any
    std::function<void(size_t, size_t)> progress;  ///< called with (done, total) cells now and then; may be empty
    /// What an earlier process found is taken from it, and what is found is added; null: neither. The answer is the same.
    RowJournal* journal = nullptr;
    /// Asked between pieces of work; true: no cell is halved any more, and the journal is kept. May be empty.
    std::function<bool()> stop;
};

struct ViewCells {
    LeafTree tree;                                    ///< a leaf is a cell; none: nothing hides, or too little does
    BitMatrix visible;                                ///< [leaves x Scene::objects]
    std::vector<uint32_t> walls;                      ///< objects that the rows rest on  [Scene::objects] rising
    double smallest_occluder = 0, smallest_cell = 0;  ///< as used  [world units]
    uint64_t hiders = 0;                              ///< flat parts
    uint64_t used = 0;                                ///< those of them that hide something from a cell
    double hidden = 0;         ///< the share of the pairs of cells within the scene and objects that is hidden
    uint64_t over_budget = 0;  ///< cells whose search ended by the budget
};

/// Divides space into boxes and finds for each a superset of the objects that can be seen from anywhere in it. Space
/// is halved where the most is seen from the most room, along a wall if one crosses the cell: so it stands wholly on
/// one side of it. What is outside of the scene sees everything.
///
/// The argument. An object is left out of a row only if one HiderCover hides its bounds from the whole cell, or from a
/// cell that holds it: each segment from there to the object passes an opaque front. Nothing else is used: how space is
/// divided and which hiders are tried cost tightness and time alone. Holes narrower than `smallest_hole` are closed, as
/// by cellsOfSoup(). An object never hides itself: its bounds hold its own surfaces, and these reach before the planes.
///
/// O(cells * objects left by their parents * log hiders). The same for any number of threads.
ViewCells viewCellsOf(const Scene& scene, const ViewCellSettings& settings = {});

}  // namespace sightline::bake
