// Why the slowest frame of a run is slow, and why the loosest keeps what nobody sees: lines for a reader.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "apps/cli/verbs/common.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// Fills FrameResult::notes of the slowest frame, and of a verified run's frame with the largest over-estimate. Explains
/// up to some hundreds of objects, each at the cost of a query.
/// @param world  that gave the run; without one it is loaded again if something is to be asked of it
void noteFrames(const Scene& scene, const RunOptions& options, std::optional<LoadedWorld> world, CullRun& run);

}  // namespace sightline::cli
