// Sources of maps of the Quake family (.map).
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::tools {

/// Reads a `.map`: sides as in Quake, with the axes of texture of Valve's version 220, with the three numbers of
/// Quake 2 and 3 behind them, and as brush primitives of Quake 3. Patches are left out, and counted. Comments run
/// from // to the line's end.
///
/// Errors (kInput) are one line with the name and the line's number: what is no such text, numbers that are not
/// finite or beyond 1e9, brushes of Doom 3 (planes by their equations), a brush of more than 4096 sides, words of
/// more than 65535 bytes, an end in the midst of something. O(bytes).
Result<QuakeMap> parseQuakeMap(std::span<const unsigned char> bytes, const std::string& name);

/// Three numbers as a value holds them ("x y z" in the map's own axes), turned as the map is; none if there are not
/// three finite ones within 1e9.
std::optional<glm::dvec3> quakeVector(std::string_view value);

}  // namespace sightline::tools
