// What a cull along a camera path gave, as JSON for a page.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/tools/report/run/cull_run.h"

namespace sightline::tools {

/// cullJson() without the lists of objects: `kept` of a frame counts what `visible` lists, and `notes` are there.
std::string cullJsonWithoutSets(const CullRun& run);

}  // namespace sightline::tools
