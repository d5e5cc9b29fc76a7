// Small scenes, each made to show where a hidden-surface method fails or what it costs.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

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

}  // namespace sightline::tools
