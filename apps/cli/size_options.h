// The options of distance and contribution culling, and what these cost in a run's pictures.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cli/common.h"
#include "sightline/report/cull_run.h"

namespace sightline::cli {

/// --distance and --contribution.
void addSizeOptions(CLI::App& verb, RunOptions& options);

/// Checks them against --use, and takes the stages out of RunOptions::stages that have nothing to do. Errors are kUsage.
Status finishSizeOptions(RunOptions& options);

/// " --distance D --contribution Npx", as far as they were given.
std::string sizeOptionsOf(double max_distance, double contribution);

/// Fills FrameResult::changed_pixels, if a stage of distance or contribution was in use; interrupted, of the first frames
/// only. Of two eyes the left one's.
void countChanges(const Scene& scene, const RunOptions& options, CullRun& run);

}  // namespace sightline::cli
