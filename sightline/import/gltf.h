// Reads the geometry of a glTF 2.0 file into a scene.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification. 2021.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/scene/scene.h"

namespace sightline {

/// Reads `.glb` or `.gltf` (external files and data URIs). Objects are the nodes with a mesh that the
/// default scene reaches (all scenes' roots if none is marked, all parentless nodes if there is no scene);
/// an object's key is its node's index.
///
/// Takes triangle lists, strips and fans (points and lines are left out); 8, 16 and 32-bit indices or none;
/// sparse, normalised and quantised accessors; KHR_mesh_quantization, EXT_meshopt_compression,
/// EXT_mesh_gpu_instancing (an object per instance, sharing the key); cameras; doubleSided, alphaMode,
/// transmission. Skinned and morphed meshes get bounds that hold for every pose and are marked as deforming.
///
/// Errors are one line that names the file, the fault and its place: truncated or oversized lengths,
/// indices out of range, positions that are not finite, cyclic nodes, missing buffers, required extensions
/// that are not known, nothing to draw.
Result<Scene> loadGltf(const std::string& path);

/// The same from memory, as a fuzzer needs it. External files are not opened.
Result<Scene> parseGltf(std::span<const unsigned char> bytes, const std::string& name);

}  // namespace sightline
