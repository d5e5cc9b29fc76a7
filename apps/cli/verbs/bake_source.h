// What `bake` bakes: the cells and objects of a map, or of a scene with cells.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/verbs/scene_choice.h"
#include "apps/cli/verbs/vis_map.h"
#include "sightline/bake/bake.h"
#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;

struct BakeSource {
    BakeCells cells;
    Scene scene;            ///< its objects; of a .map none
    std::string cells_are;  ///< where the cells come from, for people
    std::string rows_are;   ///< what has a row
    uint64_t movable = 0;   ///< objects that hide nothing, for they may be elsewhere at run time: doors, and --moves
    bool of_bsp = false;
    bool leaks = false;                   ///< of a .map
    BrushRoles roles;                     ///< of a .map: its brushes
    std::optional<SoupCellReport> walls;  ///< of cells of a scene's own walls
};

/// What of a scene is baked, and how its own walls divide it.
struct BakeSourceChoice {
    std::string cells;               ///< of --cells; empty: not given
    double smallest_occluder = -1;   ///< SoupCellSettings
    double smallest_hole = -1;       ///< SoupCellSettings
    double widest_gap = -1;          ///< SoupCellSettings
    bool of_walls = false;           ///< one of these three was given
    std::vector<std::string> moves;  ///< of --moves: keys, or parts of the paths of objects that hide nothing
    MapRules rules;                  ///< for a .map
    uint32_t view_cells = 0;         ///< ViewCellSettings::most_cells; below 2: none
    Jobs* jobs = nullptr;
    /// Gives the journal of view cells, right before they are divided; from then on interrupted() ends that early.
    std::function<Result<RowJournal*>()> begin_view_cells;
};

/// The cells of a map, those that a scene's maker marked, or where there are none those of its own walls.
/// Errors: of the readers; a scene with nothing that could divide it, a map that cannot be baked (kInput); options that a
/// file of its kind does not have (kUsage).
Result<BakeSource> loadBakeSource(const SceneChoice& scene, const BakeSourceChoice& choice);

}  // namespace sightline::cli
