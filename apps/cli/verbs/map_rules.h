// What a command line says of a map's source beside it: its game, the game's files, textures that are solid.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/cli/shell/options.h"
#include "sightline/bake/brushes/brush_role.h"
#include "sightline/base/result.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;

struct MapRules {
    std::string game;                  ///< empty: guessed
    std::vector<std::string> solid;    ///< patterns
    std::vector<std::string> shaders;  ///< paths
    bool given() const { return !game.empty() || !solid.empty() || !shaders.empty(); }
};

void addMapRules(Command& verb, MapRules& rules);

/// Reads the game's files into `materials`, which outlives the answer. Notes on standard error say which of them are not read to
/// their ends. Errors: readMapMaterials().
Result<BrushRules> brushRulesOf(const MapRules& rules, MapMaterials& materials);

/// Notes how many brushes hide nothing because nobody says what they are, and what would say it.
void noteUnknown(const std::string& map, const BrushRoles& roles);

}  // namespace sightline::cli
