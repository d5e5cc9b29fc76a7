// Which games the source of a map may be of.
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "sightline/tools/scene/map_materials.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {
using namespace tools;

/// The games that a map may be of, never none. What the editor wrote into its first lines decides (`// Game: Quake 2`); then a
/// `wad` key, which only Quake and Half-Life have; then folders in the names of textures, flags on sides, patches and brush
/// primitives, which these have not. Within the two halves classes, keys and names that only one game has decide, if none of
/// the other game's are there; then whether `materials` have scripts alone or .wal files alone.
MapGames gamesOf(const QuakeMap& map, const MapMaterials* materials = nullptr);

/// By a name as options and editors write it ("quake2", "Half-Life", "Jedi Knight"); kNoGame: it is not known.
MapGames gameOfName(std::string_view name);

/// "Quake or Half-Life".
std::string namesOfGames(MapGames games);

}  // namespace sightline::bake
