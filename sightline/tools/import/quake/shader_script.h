// Shader scripts of Quake 3 and its kin, read for one thing: what a surface with the shader hides.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/scene/map_materials.h"

namespace sightline::tools {

/// Adds the shaders of a script. One is solid only if all that it says is known, and none of it lets sight through: its first
/// stage is drawn without blending and alpha test, or it is `nodraw` as caulk is; no `surfaceparm` takes its solidity; nothing
/// moves its vertices. A word that is not known makes it BrushRole::kUnknown.
///
/// Errors (kInput) are one line with the name and the line: braces that do not match, a shader without a body. What came
/// before the fault has been added.
Status parseShaderScript(std::span<const unsigned char> bytes, const std::string& name, MapMaterials& out);

}  // namespace sightline::tools
