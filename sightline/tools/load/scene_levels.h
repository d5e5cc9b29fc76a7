// Levels of detail that a scene brings with it: named by its file, or by the names of its objects.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Takes objects that are called NAME_LOD1, NAME_LOD2 ... for levels of the one that is called NAME_LOD0 or NAME, below
/// the same node: as Unity and Unreal Engine name them. They leave the scene's objects, and stand in Scene::levels. What
/// deforms or shuts a portal stays as it is. Case does not matter.
/// @returns how many objects are levels now
uint32_t takeNamedLevels(Scene& scene);

/// Makes Mesh::lods of Scene::levels, which is empty then. Objects that share a mesh and differ in their levels get
/// meshes of their own. Levels without triangles, and what comes behind them, are left out.
void joinLevels(Scene& scene);

}  // namespace sightline::tools
