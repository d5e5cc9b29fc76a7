// What the brushes of a map's source are for sight: by their entity's class, their textures' names and flags.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/tools/scene/map_materials.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {
using namespace tools;

/// What is known of a map beside its file.
struct BrushRules {
    MapGames games = kNoGame;  ///< kNoGame: gamesOf() guesses
    /// Patterns (matches()) of textures that are solid where nothing else is known of them.
    std::vector<std::string> solid = {};
    const MapMaterials* materials = nullptr;  ///< outlives the call
};

struct BrushRoles {
    std::vector<BrushRole> roles;  ///< [size: the map's brushes]
    MapGames games = kNoGame;      ///< by whose rules
    uint64_t unknown = 0;          ///< brushes that hide nothing because a texture or a flag of theirs is not known
    std::vector<std::string> unknown_textures;  ///< of these, the most frequent first
};

/// Whether an entity's brushes are part of the world, as of func_group; of func_detail and its kin they are, too, but
/// only as detail, unless they are sky. Those of all others move, or come and go. What an editor's layer or a compiler's key
/// leaves out is no part of it.
bool isWorldEntity(const QuakeMap& map, const QuakeMapEntity& entity);

/// Of each brush what the least hiding of its sides says it is. What is not known hides nothing.
///
/// Quake and Half-Life: compilers know some names (sky..., *water, clip, hint, origin, ...); every other one is solid by their
/// rule. Quake 2: the flags of the side decide, or where it has none those of the texture's .wal. Quake 3: the texture's shader
/// decides; of a texture without one that it is solid is known only if its picture, and no fault, is among the materials. Names
/// in `common/` and `system/` are tools, of which caulk alone is solid; names with a folder that speak of liquids, fog, glass or
/// windows are that. Detail, liquids, windows, clips, hints by a flag are so in each game. Of a map that may be of several
/// games a brush hides only if it hides in each of them.
BrushRoles brushRoles(const QuakeMap& map, const BrushRules& rules = {});

}  // namespace sightline::bake
