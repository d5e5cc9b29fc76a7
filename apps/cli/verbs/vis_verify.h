// Rows of a map held against rays.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "apps/cli/verbs/vis_map.h"
#include "sightline/base/jobs.h"
#include "sightline/tools/report/run/vis_json.h"

namespace sightline::cli {
using namespace tools;

/// Half of the rays go through the map's own tree, if it has one: then the rows hold for the map, and not only for its
/// portals. The others go through the portals.
VisSummary::Verification verifyVis(const VisMap& map, const BitMatrix& visible, uint64_t rays, Jobs& jobs);

}  // namespace sightline::cli
