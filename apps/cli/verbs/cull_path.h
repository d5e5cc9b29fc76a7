// Culls a scene along a camera path on several threads, and lets the witnesses judge the answers.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "apps/cli/verbs/common.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// Gives the scene levels of detail, if the run asks for some: before any path is culled.
void prepareLods(Scene& scene, const RunOptions& options);

/// Called on the thread that has answered a frame, while its query still knows the answer.
using FrameHook = std::function<void(size_t frame, const Query& query)>;

/// A run with the cameras of a path, and no answers yet.
/// @param key_order  orderByKey() of the scene
CullRun newRun(const Scene& scene, const std::vector<uint32_t>& key_order, const CameraPath& path,
               const RunOptions& options);

/// The visible set of each frame, with times and counts; one Query a thread. The same for any number of threads,
/// but for the times. Interrupted, it hands out no more frames and finishes those begun, so that the run holds the first
/// frames of the path; CullRun::interrupted says so, and there may be none.
/// @param world     takes the world that was asked, for those who have more to ask of it; null: it is dropped
/// @param answered  may be empty
CullRun cullPath(const Scene& scene, const CameraPath& path, const RunOptions& options,
                 std::optional<LoadedWorld>* world = nullptr, const FrameHook& answered = {});

/// Judges every frame of a run that has reasons. Fills FrameResult::verification; interrupted, of the first frames only.
void verifyPath(const Scene& scene, const RunOptions& options, CullRun& run);

/// Fills FrameResult::changed_pixels, if a stage of distance or contribution was in use; interrupted, of the first frames
/// only. Of two eyes the left one's.
void countChanges(const Scene& scene, const RunOptions& options, CullRun& run);

/// Frames that have a verdict.
size_t judgedFrames(const CullRun& run);

/// What the exit code says of a run: a false cull before all; else an interruption, of which a line is printed.
/// @param frames  of the path
/// @param verify  whether every frame was to be judged
int exitCodeOf(const CullRun& run, size_t frames, bool verify);

/// Names each false cull on standard error, at most 20 a frame.
void tellFalseCulls(const Scene& scene, const CullRun& run);

/// tellFalseCulls(), and writes the cameras of the frames that have some beside the run's other files, as
/// replay-frames.json, and prints the command that judges them again. Nothing, if there are no false culls.
Status explainFalseCulls(const Scene& scene, const RunOptions& options, const CullRun& run);

/// Calls work(i) for i in [0, count) on so many threads, in any order; returns when all are done. Where memory does not
/// reach for so many threads there are fewer, and work that found none is done again: it must bear that. What work throws
/// is thrown here.
void forEach(size_t count, uint32_t threads, const std::function<void(size_t)>& work);

}  // namespace sightline::cli
