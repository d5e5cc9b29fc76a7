// A page of a bake of any scene: its cells, portals and gaps in plan, and what may be seen from each view cell.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/report/pictures/bake_plan.h"

namespace sightline::tools {

/// Writes index.html, its pictures and bake.json into a directory that is there. Errors (kOutput): of the files.
/// @param json  schema `sightline.bake/1`
Status writeBakePage(const DrawnBake& bake, const std::string& json, const std::string& directory);

}  // namespace sightline::tools
