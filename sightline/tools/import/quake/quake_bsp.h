// Compiled maps of the Quake family (.bsp): their tree, faces, visibility and entities, as plain data.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <glm/glm.hpp>

#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_map_file.h"

namespace sightline::tools {

/// "Quake (version 29)".
const char* quakeFormatName(QuakeFormat format);

/// Reads a `.bsp` of any of these formats; a file is one by its first bytes.
///
/// Errors (kInput) are one line with the name and the place: what is no such file, lumps beyond the file's end or of a
/// size that is no multiple of their records', indices out of range, numbers that are not finite or beyond 1e9, planes
/// without a direction, a tree with a cycle, a shared node or more than kDeepest levels, a face of two models.
Result<QuakeMapFile> parseQuakeBsp(std::span<const unsigned char> bytes, const std::string& name);

/// The leaf of `tree` that a point is in; on a plane, the one in front. O(depth).
uint32_t leafAt(const LeafTree& tree, const glm::dvec3& point);

}  // namespace sightline::tools
