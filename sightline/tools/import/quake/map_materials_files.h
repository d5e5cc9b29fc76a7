// A game's files that say what its textures are: shader scripts, .wal files and pictures, in folders and archives.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/scene/map_materials.h"

namespace sightline::tools {

/// The flags of a `.wal` of Quake 2. Errors (kInput) are one line with the name: it is too short, or what it holds of its
/// picture is not where it says, as in files of its kin.
Result<MapFlags> parseWal(std::span<const unsigned char> bytes, const std::string& name);

/// Adds what a path holds: a `.shader` or `.wal` file, a `.pk3` or `.pak`, or a folder with all of these below it. A texture's
/// name begins behind the last `textures/` of its path, or in the folder that was given.
///
/// A script or a .wal in a folder or an archive that cannot be read is told in MapMaterials::faults. Errors (kInput), one line
/// with the name: the path does not exist, cannot be read, is of no such kind, or holds nothing of these.
Status readMapMaterials(const std::string& path, MapMaterials& out);

}  // namespace sightline::tools
