// One frame of a path: asked, timed, and judged; by one eye or two.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/query/query.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/truth/verify.h"

namespace sightline::cli {
using namespace tools;

/// The view of a frame; of a run for two eyes the left one's, which pictures and explanations show.
/// @param run  CullRun or RunOptions
template <class Run>
View viewOf(const CameraFrame& camera, const Run& run) {
    View view = makeView(camera, run.width, run.height);
    view.jitter = run.jitter;
    view.sections = run.sections;
    return run.stereo > 0 ? shiftedEye(view, -0.5 * run.stereo) : view;
}

/// Queries one frame `repeat` times for the time of the whole, and once more for the times of the stages.
/// @param before  the frame before it, which the query answers first each time, with a memory: so the answer is
///                the same for any number of threads; null: there is none
void cullFrame(const Snapshot& now, const CullRun& run, const CameraFrame* before, Query& query, FrameResult& frame);

/// The certificates by which the last answer culled, those that name the same objects as one.
/// @param reasons  of that answer
std::vector<CertificateRow> certificatesOf(const Query& query, const std::vector<ObjectId>& ids,
                                           const std::vector<uint8_t>& reasons);

/// Per object 0 if the stage of the frustum alone would keep it in a frame.
std::vector<uint8_t> reasonsOfFrustum(const Snapshot& now, const CullRun& run, const CameraFrame& camera, Query& query);

/// What the witnesses say of a frame; of two eyes, each is held to its own answer, and what is said is of both.
FrameVerdict judgeFrame(const Witness& witness, const CullRun& run, const FrameResult& frame,
                        const WitnessSettings& settings);

}  // namespace sightline::cli
