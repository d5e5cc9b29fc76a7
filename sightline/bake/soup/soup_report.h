// How a scene's own walls divide it, and what is told of that.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/jobs.h"
#include "sightline/cells/cell_space.h"

namespace sightline::bake {

struct SoupCellSettings {
    /// What divides space: opaque sheets that hang together and are at least as large as a square of this side. Smaller
    /// ones hide as occluders alone. Negative: a 128th of the core's diagonal (SceneCore) or, if there are `eyes`, two, four or eight
    /// times as much, as long as they see at most a fifth more.  [world units]
    double smallest_occluder = -1;
    std::vector<glm::dvec3> eyes;  ///< places that are asked how much is seen from them
    /// Holes that are narrower are no holes: as much as coordinates of the walls about them may be off. A larger one
    /// closes holes that light passes, which is not conservative. Negative: 2^-22 of the largest coordinate of the wall
    /// beside the hole, which is four units in the last place of what files hold.  [world units]
    double smallest_hole = -1;
    /// Slits between walls are listed as gaps, which were probably meant to be shut, if they are no wider. 0: none are.
    /// Negative: 2^-12 of the core's diagonal.  [world units]
    double widest_gap = -1;
    uint32_t most_cells = 1u << 15;  ///< [limit: >= 1]
    uint32_t most_holes = 32;        ///< pieces of the holes of one face; more become their hull  [limit: >= 1]
    std::vector<uint32_t> movable;   ///< objects that may be elsewhere at run time: they hide nothing  [Scene::objects]
    Jobs* jobs = nullptr;            ///< threads to share the faces out to; the answer is the same with any
    std::function<void(size_t, size_t)> progress;  ///< called with (done, total) faces now and then; may be empty
};

/// What a size of `smallest_occluder` gives.
struct SoupTrial {
    double smallest_occluder = 0;
    uint64_t cells = 0, portals = 0;
    double objects_seen = 0;   ///< in cells that a place sees, all round; the mean of the places
    double portals_tried = 0;  ///< by the walks of a place
};

/// A straight slit between two walls. It is a portal like any other, so that nothing seen through it is lost.
struct WallGap {
    glm::dvec3 from{0.0}, to{0.0};  ///< its ends, in the middle of it
    double width = 0;               ///< where it is widest  [world units] [> 0]
    uint32_t objects[2] = {0,
                           0};  ///< whose surfaces bound it; twice the same if both are of one  [Scene::objects] rising
    double length() const { return glm::distance(from, to); }
};

struct SoupCellReport {
    std::vector<SoupTrial> trials;  ///< the finest first; none without `eyes`
    uint64_t objects = 0;           ///< of the scene, that trials speak of
    double smallest_occluder = 0;   ///< as used  [world units]
    double smallest_hole = 0;       ///< the largest that was used  [world units]
    std::vector<uint32_t> aside;    ///< SceneCore::aside: these are no walls
    uint64_t triangles = 0;         ///< opaque ones
    uint64_t sheets = 0;            ///< planes that may divide
    uint64_t faces = 0;             ///< between leaves
    uint64_t closed = 0;            ///< faces that walls cover wholly, from both sides
    uint64_t one_way = 0;           ///< portals that are seen through from one side alone
    uint64_t merged = 0;            ///< faces whose holes became their hull
    uint32_t depth = 0;             ///< of the tree
    bool full = false;              ///< `most_cells` ended the division
    double widest_gap = 0;          ///< as used  [world units]
    std::vector<WallGap> gaps;      ///< the largest first, by width times length
    /// Whether the trial of what was used saw a quarter of the objects or more; false without trials.
    bool hardlyAnInside() const {
        for (const SoupTrial& trial : trials)
            if (trial.smallest_occluder == smallest_occluder)
                return trial.objects_seen > 0.25 * static_cast<double>(objects);
        return false;
    }
    std::vector<uint32_t> walls;  ///< objects that the answer rests on: while they stand, are drawn and are opaque it
                                  ///< holds  [Scene::objects] rising
};

struct SoupCells {
    CellSpace space;  ///< of a tree; without cells if nothing of the scene is opaque and large enough
    SoupCellReport report;
};

}  // namespace sightline::bake
