// Nodes that a level's maker marked as cells and portals, as cells and portals of a scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/tools/import/gltf/gltf_document.h"
#include "sightline/tools/import/gltf/gltf_meshes.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

/// Adds the marked nodes' cells and portals to a scene that has its objects.
void addMarked(Document& document, const NodeTree& tree, const std::vector<MeshSource>& meshes, Scene& scene);

}  // namespace sightline::tools::gltf
