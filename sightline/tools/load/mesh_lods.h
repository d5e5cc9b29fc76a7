// Levels of detail of a scene's meshes: made where there are none, and measured where the scene brought its own.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/lod/lod_chain.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Below so many triangles a mesh is drawn as it is.
inline constexpr size_t kLeastForLods = 64;

/// The levels that are made of a mesh; none if it has its own, deforms, or has few triangles.
LodChain lodChainOf(const Mesh& mesh, const LodChainSettings& settings = {});

/// Gives a mesh levels that were made of it.
/// @returns false, with nothing done, if the chain is not of this mesh
bool setMeshLods(Mesh& mesh, const LodChain& chain);

/// Gives a mesh its levels, or measures the errors of those that it has. Of its own levels those stay that have fewer
/// triangles and larger errors than the ones before. A mesh that deforms keeps one level. Meshes can be worked on by
/// threads at the same time.
void addMeshLods(Mesh& mesh, const LodChainSettings& settings = {});

/// What a world is told of a mesh: finest first, and no more than one level if there are no others.
std::vector<LodLevel> lodLevels(const Mesh& mesh);

}  // namespace sightline::tools
