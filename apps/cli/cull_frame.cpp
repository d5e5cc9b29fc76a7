// One frame of a path: asked, timed, and judged; by one eye or two.
// SPDX-License-Identifier: MIT
#include "apps/cli/cull_frame.h"

#include <algorithm>

#include "apps/cli/visibility_options.h"

namespace sightline::cli {
namespace {

/// What a query did, of both eyes together.
QueryStats sumOf(const StereoSet& set) {
    QueryStats sum = set.left;
    for (int stage = 0; stage < kStageCount; ++stage) {
        sum.stages[stage].doubt += set.right.stages[stage].doubt;
        sum.stages[stage].nanoseconds += set.right.stages[stage].nanoseconds;
    }
    sum.occluder_triangles += set.right.occluder_triangles;
    sum.budget_spent |= set.right.budget_spent;
    sum.nodes_visited += set.right.nodes_visited;
    sum.seam_pixels += set.right.seam_pixels;
    sum.closed_gaps += set.right.closed_gaps;
    sum.faces_tested += set.right.faces_tested;
    sum.faces_culled += set.right.faces_culled;
    sum.second_looks += set.right.second_looks;
    sum.second_look_culled += set.right.second_look_culled;
    sum.second_look_polygons += set.right.second_look_polygons;
    sum.second_look_spent |= set.right.second_look_spent;
    sum.nanoseconds += set.right.nanoseconds;
    return sum;
}

QueryStats ask(const Snapshot& now, const CullRun& run, const View& view, Query& query) {
    if (run.stereo > 0) return sumOf(query.visibleStereo(now, view, shiftedEye(view, run.stereo)));
    return query.visible(now, view).stats;
}

/// What is held to be hidden: not what distance, contribution and a limited depth of portals culled, which may be seen.
std::vector<uint8_t> provable(std::vector<uint8_t> reasons, const CullRun& run) {
    for (uint8_t& reason : reasons)
        if (isLossy(reason, run)) reason = 0;
    return reasons;
}

}  // namespace

View viewOf(const CameraFrame& camera, const CullRun& run) {
    View view = makeView(camera, run.width, run.height);
    view.jitter = run.jitter;
    view.stages = run.stages;
    view.max_distance = run.max_distance;
    view.contribution = run.contribution;
    view.sections = run.sections;
    applyVisibility(run.visibility, view);
    view.hysteresis = 0;  // each frame stands by itself, whichever thread answered the one before it
    view.occluder_triangles = run.occluder_triangles;
    view.occluder_error = run.occluder_error;
    view.occlusion_detail = run.masked ? OcclusionDetail::kMasked : OcclusionDetail::kFull;
    view.close_gaps = run.close_gaps;
    view.occlusion_size = run.occlusion_size;
    view.faces = run.faces;
    view.second_look = run.second_look;
    view.second_look_polygons = run.second_look_polygons;
    view.bins = run.bins;
    return run.stereo > 0 ? shiftedEye(view, -0.5 * run.stereo) : view;
}

void cullFrame(const Snapshot& now, const CullRun& run, const CameraFrame* before, Query& query, FrameResult& frame) {
    View view = viewOf(frame.camera, run);
    view.last_visible_first = run.last_visible_first && before;
    if (before) view.hysteresis = run.hysteresis;
    const auto answer = [&] {
        if (view.last_visible_first || view.hysteresis > 0) ask(now, run, viewOf(*before, run), query);
        return ask(now, run, view, query);
    };
    std::vector<double> times;
    for (int i = 0; i < run.repeat; ++i) times.push_back(1e-3 * static_cast<double>(answer().nanoseconds));
    frame.query_microseconds = medianOf(std::move(times));
    // Apart from the others, since the clock that stages are timed by takes time itself.
    view.time_stages = true;
    std::vector<double> stage_times[kStageCount];
    QueryStats stats;
    for (int i = 0; i < run.repeat; ++i) {
        stats = answer();
        for (int stage = 0; stage < kStageCount; ++stage)
            stage_times[stage].push_back(1e-3 * static_cast<double>(stats.stages[stage].nanoseconds));
    }
    for (int stage = 0; stage < kStageCount; ++stage) {
        frame.stages[stage].doubt = stats.stages[stage].doubt;
        frame.stages[stage].microseconds = medianOf(std::move(stage_times[stage]));
    }
    frame.occluder_triangles = stats.occluder_triangles;
    frame.budget_spent = stats.budget_spent;
    frame.nodes_visited = stats.nodes_visited;
    frame.seam_pixels = stats.seam_pixels;
    frame.closed_gaps = stats.closed_gaps;
    frame.faces_tested = stats.faces_tested;
    frame.faces_culled = stats.faces_culled;
    frame.second_looks = stats.second_looks;
    frame.second_look_culled = stats.second_look_culled;
    frame.second_look_polygons = stats.second_look_polygons;
    frame.second_look_spent = stats.second_look_spent;
    if (run.stages & stageBit(Stage::kClusters) && !(run.stereo > 0))
        frame.clusters = {stats.clusters_tested,   stats.clusters_back,   stats.clusters_outside, stats.clusters_hidden,
                          stats.cluster_triangles, stats.drawn_triangles, stats.draw_ranges};
    if (run.stages & stageBit(Stage::kPortals) && !(run.stereo > 0)) {
        const CellStats cells = query.cellStats();
        frame.cells = {cells.cells, cells.portals, cells.whole, cells.too_deep, cells.known};
    }
    frame.reasons.resize(now.objectCount());
    query.reasons(frame.reasons);
    if (!(run.stereo > 0)) return;
    for (const uint8_t eye : {kLeftEye, kRightEye}) {
        std::vector<uint8_t>& reasons = frame.eye_reasons[eye - 1];
        reasons.resize(now.objectCount());
        query.reasons(reasons, eye);
    }
}

FrameVerdict judgeFrame(const Witness& witness, const CullRun& run, const FrameResult& frame,
                        const WitnessSettings& settings) {
    const View view = viewOf(frame.camera, run);
    if (!(run.stereo > 0)) return witness.judge(view, provable(frame.reasons, run), settings);
    FrameVerdict both = witness.judge(view, provable(frame.eye_reasons[0], run), settings);
    const FrameVerdict right =
        witness.judge(shiftedEye(view, run.stereo), provable(frame.eye_reasons[1], run), settings);
    for (const FalseCull& cull : right.false_culls) {
        const auto same = [&](const FalseCull& other) { return other.object == cull.object; };
        if (std::none_of(both.false_culls.begin(), both.false_culls.end(), same)) both.false_culls.push_back(cull);
    }
    std::sort(both.false_culls.begin(), both.false_culls.end(),
              [](const FalseCull& a, const FalseCull& b) { return a.object < b.object; });
    both.rays += right.rays;
    both.aimed_rays += right.aimed_rays;
    both.id_samples += right.id_samples;
    both.supersampling = std::min(both.supersampling, right.supersampling);
    both.unconfirmed += right.unconfirmed;
    both.seen.resize(std::max(both.seen.size(), right.seen.size()), 0);
    for (size_t i = 0; i < right.seen.size(); ++i) both.seen[i] |= right.seen[i];
    both.exactly_visible = static_cast<uint64_t>(std::count(both.seen.begin(), both.seen.end(), uint8_t{1}));
    return both;
}

}  // namespace sightline::cli
