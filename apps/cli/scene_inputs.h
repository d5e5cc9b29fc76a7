// Which files a scene's file leads to, found without reading the scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sightline::cli {

/// The file itself (of a map in an archive, the archive) and those that its reader will read with it: the buffers of a glTF,
/// the material libraries of an OBJ, nothing of a compiled map, and of any other format, or of a file that cannot be understood, all files of its directory that have its stem.
/// They need not exist; none is named twice.
std::vector<std::string> filesOfScene(const std::string& file);

}  // namespace sightline::cli
