// Reads the geometry of a glTF 2.0 file into a scene.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification. 2021.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Reads `.glb` or `.gltf` (external files and data URIs). Objects are the nodes with a mesh that the
/// default scene reaches (all scenes' roots if none is marked, all parentless nodes if there is no scene);
/// an object's key is its node's index. Scene::nodes holds every node of the file, in its order.
///
/// Takes triangle lists, strips and fans (points and lines are left out); 8, 16 and 32-bit indices or none;
/// sparse, normalised and quantised accessors; KHR_mesh_quantization, EXT_meshopt_compression and
/// KHR_meshopt_compression as far as the library goes, KHR_draco_mesh_compression if this was built with Draco (and only
/// for primitives that have no other data), EXT_mesh_gpu_instancing (an object per instance, sharing the key); cameras;
/// doubleSided, alphaMode, transmission. Skinned and morphed meshes get bounds that hold for every pose and are marked as deforming:
/// joints turned in any way, translated and scaled as at rest or as an animation asks; morph weights from 0
/// to 1, their defaults, and what animations make of them. Joints place a skinned mesh, its node does not; with
/// and without a skin, or with other morph weights, one glTF mesh becomes several. Nodes that animations
/// move as a whole stay at their rest pose and count as static: who plays the animation moves the object.
/// Vertices that no triangle uses are dropped. KHR_node_visibility leaves out what it hides.
///
/// Errors are one line that names the file, the fault and its place: truncated or oversized lengths,
/// indices out of range, positions that are not finite, cyclic nodes, missing buffers, required extensions
/// that are not known, nothing to draw.
///
/// Memory is bounded by 64 MiB plus 512 times the size of the files, and 4096 times that of Draco data, though
/// not above 2 GiB for that reason. What reading takes beside the scene itself is far
/// less: the JSON stays text, of which one element of a table at a time becomes values, 250 bytes or so a node, and those
/// blocks of the files that some triangle needs, once. A file of a million named nodes takes four times its size.
///
/// @param progress  called now and then, from this thread, with how much of the work is done; `total` stays the same,
///                  `done` grows and ends there
/// @param note  called with a line for what the reader took otherwise than the file may mean; may be empty
Result<Scene> loadGltf(const std::string& path, const std::function<void(size_t done, size_t total)>& progress = {},
                       const std::function<void(const std::string& text)>& note = {});

/// The same from memory, as a fuzzer needs it. External files are not opened.
Result<Scene> parseGltf(std::span<const unsigned char> bytes, const std::string& name);

}  // namespace sightline::tools
