// What a run says to a reader: totals of a path, verdicts of its frames.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "apps/cli/verbs/common.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// Means over the frames: objects kept, culled by stage, triangles, microseconds; and the verdict if there is one.
/// Nothing with --quiet. There must be frames.
void printSummary(std::FILE* out, const CullRun& run);

/// One line for each frame that was judged, then the sums. Nothing with --quiet.
void printVerdicts(std::FILE* out, const CullRun& run);

/// The command that repeats a run.
std::string replayOfRun(const RunOptions& options, bool verify);

}  // namespace sightline::cli
