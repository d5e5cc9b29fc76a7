// Reads cameras and places them where drawn nodes hold them.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/tools/import/gltf/gltf_nodes.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

/// A camera without its place.
using CameraSource = SceneCamera;

std::vector<CameraSource> readCameras(const JsonText& json);

/// One camera for each drawn node that holds one, by node; a node that is flattened to nothing holds none.
std::vector<SceneCamera> placeCameras(const NodeTree& tree, const std::vector<CameraSource>& cameras);

}  // namespace sightline::tools::gltf
