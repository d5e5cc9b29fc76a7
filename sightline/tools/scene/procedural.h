// Procedural scenes by their specification, and the small made ones that show where a hidden-surface method fails.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// A made scene's name, and in a few words what it shows.
struct MadeScene {
    std::string_view name, shows;
};

/// All of them, in the order in which they are listed to users.
const std::vector<MadeScene>& madeScenes();

/// Makes the scene of that name: one double-sided object a shape, each with a material, a colour and a key of its own,
/// and one camera that looks at them; Scene::name is `made:NAME`. Nothing if there is no such name.
///
///     cycle     three bars, each over the next: no order of whole bars is right
///     crossing  three triangles through one another
///     coplanar  three squares that overlap in one slanted plane, all of their corners exactly in it
///     near      a long floor and a small square on its far part: the floor's centre is nearer than the square's
///     walls     eight walls one behind the other, listed far to near; each fills images of up to 4 : 1
///     eye       five triangles with corners before and behind the eye
std::optional<Scene> makeMadeScene(std::string_view name);

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
