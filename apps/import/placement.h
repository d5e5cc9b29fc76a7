// What Assimp leaves to others: units and axes that a file declares, and cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <assimp/scene.h>
#include <glm/glm.hpp>

#include "sightline/tools/scene/scene.h"

namespace sightline::import {
using namespace tools;

/// What turns a scene so that y is up, and scales it to metres, where the format says how and Assimp did not: FBX by
/// its global settings. The identity for all others.
glm::dmat4 placementOf(const aiScene& scene, const std::string& suffix);

/// A camera in the world; none if it looks nowhere.
/// @param node  node to world
std::optional<SceneCamera> cameraOf(const aiCamera& camera, const glm::dmat4& node);

}  // namespace sightline::import
