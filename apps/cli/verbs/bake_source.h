// What `bake` bakes: the cells and objects of a map, or of a scene with cells.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

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
    bool of_bsp = false;
    bool leaks = false;  ///< of a .map
};

/// Errors: of the readers; a scene without cells, a map that cannot be baked (kInput); options that a file of its kind
/// does not have (kUsage).
/// @param cells  of a .bsp: what has a row
Result<BakeSource> loadBakeSource(const SceneChoice& scene, VisCells cells, bool cells_given);

}  // namespace sightline::cli
