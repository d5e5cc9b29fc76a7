// Procedural scenes by their specification: city:SEED:OBJECTS, building:SEED:FLOORS, terrain:SEED:SIZE, made:NAME.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// True if the text begins with the name of a procedural scene and a colon; anything else is a file's name.
bool isProcedural(const std::string& spec);

/// Makes the scene that a specification names; its name is the specification.
///
///     city:SEED:OBJECTS       makeCity; OBJECTS from 1 to 10,000,000
///     building:SEED:FLOORS    makeBuilding; FLOORS from 1 to 200
///     terrain:SEED:SIZE       makeTerrain; SIZE from 16 to 8192
///     made:NAME               makeMadeScene
///
/// Errors (kUsage) quote the specification: an unknown name, a part that is missing or too many, a number that
/// is malformed or out of its limits.
Result<Scene> makeProcedural(const std::string& spec);

}  // namespace sightline::tools
