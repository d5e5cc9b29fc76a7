// What a run says to a reader: totals of a path, verdicts of its frames, why its slowest and its loosest are so.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "apps/cli/verbs/common.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// Fills FrameResult::notes of the slowest frame, and of a verified run's frame with the largest over-estimate. Explains
/// up to 300 objects, in large scenes down to 20, each at the cost of a query, and shows progress.
/// @param world  that gave the run; without one it is loaded again if something is to be asked of it
void noteFrames(const Scene& scene, const RunOptions& options, std::optional<LoadedWorld> world, CullRun& run);

/// Means over the frames: objects kept, culled by stage, triangles, microseconds; and the verdict if there is one.
/// Nothing with --quiet. There must be frames.
void printSummary(std::FILE* out, const CullRun& run);

/// One line for each frame that was judged, then the sums. Nothing with --quiet.
void printVerdicts(std::FILE* out, const CullRun& run);

/// The command that repeats a run.
std::string replayOfRun(const RunOptions& options, bool verify);

}  // namespace sightline::cli
