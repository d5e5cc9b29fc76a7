// Writes a glTF again with its meshes cut: materials, textures, animations and all else as they were.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification. 2021.
#pragma once

#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/export/gltf_scene.h"
#include "sightline/tools/scene/split.h"

namespace sightline::tools {

/// The file as a GLB that draws what is left of its triangles. A node whose mesh was cut has a child for each piece, and
/// keeps its index, as all nodes do; a mesh whose triangles are all there stays as it is. Vertices keep all their
/// attributes, bit for bit; each piece has vertices of its own, so that its bounds are its own. Images beside the file are put into it.
/// GPU instances of a node share their pieces: one goes where no instance needs it. Points and lines stay.
///
/// Notes tell of extensions that are not known, which are left out, and of images that were not found. Errors
/// (kInput): what loadGltf() finds, or a file that changed since the scene was read. Errors (kOutput): more than 4 GiB.
/// @param cut  of the scene that loadGltf() read from this file
Result<WrittenGltf> cutGltf(const std::string& file, const CutScene& cut);

/// The same from memory, as a fuzzer needs it: files beside it are not opened.
Result<WrittenGltf> cutGltf(std::span<const unsigned char> bytes, const std::string& name, const CutScene& cut);

}  // namespace sightline::tools
