// What `bake` bakes: a map or a scene with cells, as cells for run time, the graph that rows are of, and objects.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/scene_choice.h"
#include "apps/cli/vis_map.h"
#include "sightline/bake/object_cells.h"
#include "sightline/bake/scene_cells.h"
#include "sightline/base/result.h"
#include "sightline/scene/scene.h"
#include "sightline/space/cell_space.h"

namespace sightline::cli {

struct BakeSource {
    std::string name;                   ///< of the map's file, or of the scene
    std::string cells_are;              ///< where the cells come from, for people
    std::string rows_are;               ///< what has a row
    uint64_t hash = 0;                  ///< VisibilityContent::map_hash
    CellSpace space;                    ///< with row_of_cell
    CellGraph rows;                     ///< its cells have the rows
    std::vector<uint32_t> row_of_leaf;  ///< of a map
    Scene scene;                        ///< its objects; of a .map none
    ObjectCellSettings placing;
    std::optional<SceneCellReport> report;  ///< of a scene with cells
    bool leaks = false;                     ///< of a .map
};

/// @param cells  of a map: what has a row
/// Errors: of the readers; a scene without cells, a map that cannot be baked (kInput); what cannot be asked of a file of
/// its kind (kUsage).
Result<BakeSource> loadBakeSource(const SceneChoice& scene, VisCells cells, bool cells_given);

}  // namespace sightline::cli
