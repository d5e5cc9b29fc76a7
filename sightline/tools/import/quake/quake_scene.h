// A compiled map as a scene: an object for each of its faces.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/quake_map.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// The entities of a compiled map: its text is a `.map` without brushes. Errors as parseQuakeMap's.
Result<QuakeMap> quakeEntities(const QuakeMapFile& map, const std::string& name);

/// An object's key is its face's index, its name the texture's; it hangs in a node for its entity, "worldspawn" or as
/// "func_door *3", and stands where that entity's `origin` says. quakeSurface() tells what hides: see-through faces are
/// AlphaMode::kBlend, those of entities transmissive, patches deform within their control points. Faces that are not
/// drawn are left out. Cameras are the places where players begin, at the height of their eyes.
///
/// Errors (kInput) are one line with the name: entities that cannot be read, an origin that is none, a model that
/// entities show too often, nothing that is drawn.
Result<Scene> quakeScene(const QuakeMapFile& map, const std::string& name);

/// Reads the map by readMapBytes(), and makes a scene of it.
Result<Scene> loadQuakeScene(const std::string& name);

}  // namespace sightline::tools
