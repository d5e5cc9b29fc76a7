// Cells and portals of any polygons: the leaves of a tree of their own planes, and all of its faces that no wall covers.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sightline/base/jobs.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

struct SoupCellSettings {
    /// What divides space: opaque sheets that hang together and are at least as large as a square of this side. Smaller
    /// ones hide as occluders alone. Negative: a hundred-and-twenty-eighth of the scene's diagonal.  [world units]
    double smallest_occluder = -1;
    /// Holes that are narrower are no holes: as much as coordinates of the scene may be off. A larger one closes
    /// holes that light passes, which is not conservative. Negative: 2^-23 of the scene's diagonal.  [world units]
    double smallest_hole = -1;
    uint32_t most_cells = 1u << 15;  ///< [limit: >= 1]
    uint32_t most_holes = 32;        ///< pieces of the holes of one face; more become their hull  [limit: >= 1]
    std::vector<uint32_t> movable;   ///< objects that may be elsewhere at run time: they hide nothing  [Scene::objects]
    Jobs* jobs = nullptr;            ///< threads to share the faces out to; the answer is the same with any
    std::function<void(size_t, size_t)> progress;  ///< called with (done, total) faces now and then; may be empty
};

struct SoupCellReport {
    double smallest_occluder = 0, smallest_hole = 0;  ///< as used  [world units]
    uint64_t triangles = 0;                           ///< opaque ones
    uint64_t sheets = 0;                              ///< planes that may divide
    uint64_t faces = 0;                               ///< between leaves
    uint64_t closed = 0;                              ///< faces that walls cover wholly, from both sides
    uint64_t one_way = 0;                             ///< portals that are seen through from one side alone
    uint64_t merged = 0;                              ///< faces whose holes became their hull
    uint32_t depth = 0;                               ///< of the tree
    bool full = false;                                ///< `most_cells` ended the division
    std::vector<uint32_t> walls;  ///< objects that the answer rests on: while they stand, are drawn and are opaque it
                                  ///< holds  [Scene::objects] rising
};

struct SoupCells {
    CellSpace space;  ///< of a tree; without cells if nothing of the scene is opaque and large enough
    SoupCellReport report;
};

/// Divides a scene without marks into convex cells. A sight line that leaves a cell either meets a drawn, opaque front or
/// passes a portal, whatever the polygons are: one-sided, open, turned round, doubled, through one another. Which planes
/// divide and how tight they are never makes it wrong: where no wall is known there is a portal.
///
/// The argument. Leaves fill space, so a sight line that goes from leaf to leaf crosses a face, which lies in a node's
/// plane. Think of the boundary between the leaves as bent through the triangles that lie in that plane to within half of
/// smallest_hole. Of a face, the portal from A to B is what is left of it once those triangles are taken away whose fronts
/// A sees; a line that crosses elsewhere has met such a front. Triangles are grown by a third of smallest_hole before, as
/// sheets that meet do not do so bit for bit: so holes narrower than that are closed. Portals are widened by smallest_hole, and what
/// is as close to a plane belongs to both sides.
///
/// O(triangles * log) for the tree, and for faces their number times the triangles of their planes that are near.
SoupCells cellsOfSoup(const Scene& scene, const SoupCellSettings& settings = {});

}  // namespace sightline::bake
