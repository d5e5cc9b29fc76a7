// What the brushes of a map's source are for sight: by their entity's class, their textures' names and flags.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {
using namespace tools;

/// What a brush does to the tree.
enum class BrushRole : uint8_t {
    kSolid,    ///< hides, and seals
    kSky,      ///< seals; a sight line ends in it
    kLiquid,   ///< another medium
    kNothing,  ///< neither: detail, clips, triggers, hints; what hides only sometimes hides nothing here
};

/// Whether an entity's brushes are part of the world, as of func_group; of func_detail and its kin they are, too, but
/// only as detail, unless they are sky. Those of all others move, or come and go. What an editor's layer or a compiler's key
/// leaves out is no part of it.
bool isWorldEntity(const QuakeMap& map, const QuakeMapEntity& entity);

/// Of a brush of an entity. A brush is what the least hiding of its sides says it is.
///
/// Names are Quake's and Half-Life's (sky..., *water, clip, hint, origin, ...), without the folders of Quake 2 and 3, of
/// which `common/` and `system/` hold what is not drawn: of them only caulk is solid. Names with a folder that speak of
/// liquids, fog, glass or windows are that. Flags of Quake 2 and 3: detail, liquids, sky, windows, clips, hints. What
/// another name of Quake 3's shaders means is not known here: it is solid, which is wrong of what one sees through.
BrushRole roleOf(const QuakeMap& map, const QuakeMapEntity& entity, const QuakeMapBrush& brush);

}  // namespace sightline::bake
