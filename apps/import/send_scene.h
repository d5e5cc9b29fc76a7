// Reads a file with Assimp and sends what it holds: nodes, meshes, objects, cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
using namespace tools;

/// Geometry is taken as it is in the file: no vertex is moved or merged with one that is not the same, no triangle is
/// left out, the tree of nodes stays. A node's meshes become one object with a primitive for each; nodes with the same
/// meshes share them. Throws a Fault, or what Assimp throws.
/// @param suffix  of the format: "obj"
void sendScene(const std::string& file, const std::string& suffix, SceneStreamWriter& out);

}  // namespace sightline::import
