// Culls a scene along a camera path on several threads, and lets the witnesses judge the answers.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "apps/cli/common.h"
#include "sightline/report/cull_run.h"

namespace sightline::cli {

/// The visible set of each frame, with times and counts; one Query a thread. The same for any number of threads,
/// but for the times.
CullRun cullPath(const Scene& scene, const CameraPath& path, const RunOptions& options);

/// Judges every frame of a run. Fills FrameResult::verification.
void verifyPath(const Scene& scene, const RunOptions& options, CullRun& run);

/// For each frame with false culls: writes its camera beside the run's other files as replay-frame-N.json, and
/// prints each false cull with the command that replays it on standard error.
Status explainFalseCulls(const Scene& scene, const RunOptions& options, const CullRun& run);

/// Calls work(i) for i in [0, count) on so many threads, in any order; returns when all are done.
void forEach(size_t count, uint32_t threads, const std::function<void(size_t)>& work);

}  // namespace sightline::cli
