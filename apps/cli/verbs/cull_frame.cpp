// One frame of a path: asked, timed, and judged; by one eye or two.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/cull_frame.h"

#include <algorithm>
#include <map>

#include "sightline/world/world_state.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Notes by which levels of detail objects are drawn.
void noteLods(const Snapshot& now, std::span<const Visible> objects, std::span<const VisibleLod> drawn,
              std::vector<uint8_t>* lods) {
    if (!lods || drawn.empty()) return;
    lods->assign(now.objectCount(), 0);
    for (size_t i = 0; i < drawn.size(); ++i)
        (*lods)[now.state().itemOf(now.state().find(objects[i].id))] = drawn[i].level;
}

/// @param lods  receives the levels of detail, per object, if any were chosen; may be null
/// @returns what the query did, of both eyes together
QueryStats ask(const Snapshot& now, const CullRun& run, const CameraFrame& camera, const QuerySettings& settings,
               Query& query, std::vector<uint8_t>* lods = nullptr) {
    const View view = viewOf(camera, run);
    if (!(run.stereo > 0)) {
        const VisibleSet set = query.visible(now, view, settings);
        noteLods(now, set.objects, set.lods, lods);
        return set.stats;
    }
    const StereoSet set = query.visibleStereo(now, view, shiftedEye(view, run.stereo), settings);
    noteLods(now, set.objects, set.lods, lods);
    QueryStats sum = set.left;
    sum.addWork(set.right);
    return sum;
}

/// What is held to be hidden: not what distance, contribution, a budget and a limited depth of portals culled, which may be seen.
std::vector<uint8_t> provable(std::vector<uint8_t> reasons, const CullRun& run) {
    for (uint8_t& reason : reasons)
        if (isLossy(reason, run)) reason = 0;
    return reasons;
}

}  // namespace

void cullFrame(const Snapshot& now, const CullRun& run, const CameraFrame* before, Query& query, FrameResult& frame) {
    const bool remembers = !run.settings.stateless;  // then it is asked once: asked again it would know the answer
    // Each frame stands by itself, whichever thread answered the one before it, unless it is asked after that one.
    QuerySettings alone = run.settings;
    alone.hysteresis = 0;
    QuerySettings settings = before || remembers ? run.settings : alone;
    const auto answer = [&] {
        if (settings.hysteresis > 0 && !remembers) ask(now, run, *before, alone, query);
        return ask(now, run, frame.camera, settings, query, settings.time_stages ? &frame.lods : nullptr);
    };
    std::vector<double> times;
    for (int i = 0; i < run.repeat && !remembers; ++i)
        times.push_back(1e-3 * static_cast<double>(answer().nanoseconds));
    // Apart from the others, since the clock that stages are timed by takes time itself.
    settings.time_stages = true;
    std::vector<double> stage_times[kStageCount];
    QueryStats stats;
    for (int i = 0; i < run.repeat; ++i) {
        stats = answer();
        if (remembers) times.push_back(1e-3 * static_cast<double>(stats.nanoseconds));
        for (int stage = 0; stage < kStageCount; ++stage)
            stage_times[stage].push_back(1e-3 * static_cast<double>(stats.stages[stage].nanoseconds));
    }
    frame.query_microseconds = medianOf(std::move(times));
    for (int stage = 0; stage < kStageCount; ++stage) {
        frame.stages[stage].doubt = stats.stages[stage].doubt;
        frame.stages[stage].microseconds = medianOf(std::move(stage_times[stage]));
    }
    frame.stats = stats;
    if (run.settings.stages & stageBit(Stage::kClusters) && !(run.stereo > 0))
        frame.clusters = {stats.clusters_tested,   stats.clusters_back,   stats.clusters_outside, stats.clusters_hidden,
                          stats.cluster_triangles, stats.drawn_triangles, stats.draw_ranges};
    if (run.settings.stages & stageBit(Stage::kPortals) && !(run.stereo > 0)) {
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

std::vector<CertificateRow> certificatesOf(const Query& query, const std::vector<ObjectId>& ids,
                                           const std::vector<uint8_t>& reasons) {
    std::map<std::vector<uint32_t>, std::vector<uint32_t>> hidden_by;
    std::vector<uint32_t> place_of;  // by ObjectId::index
    for (uint32_t i = 0; i < ids.size(); ++i) {
        if (ids[i].index >= place_of.size()) place_of.resize(ids[i].index + size_t{1});
        place_of[ids[i].index] = i;
    }
    Array<Visible> named;
    for (uint32_t object = 0; object < ids.size(); ++object) {
        if (reasons[object] == 0 || !query.certificateOf(ids[object], named)) continue;
        std::vector<uint32_t> hiders;
        for (const Visible& hider : named) hiders.push_back(place_of[hider.id.index]);
        std::sort(hiders.begin(), hiders.end());
        hidden_by[std::move(hiders)].push_back(object);
    }
    std::vector<CertificateRow> rows;
    for (auto& [hiders, hidden] : hidden_by) rows.push_back({hiders, std::move(hidden)});
    return rows;
}

std::vector<uint8_t> reasonsOfFrustum(const Snapshot& now, const CullRun& run, const CameraFrame& camera,
                                      Query& query) {
    QuerySettings settings = run.settings;
    settings.stages = stageBit(Stage::kFrustum);
    settings.hysteresis = 0;
    ask(now, run, camera, settings, query);
    std::vector<uint8_t> reasons(now.objectCount());
    query.reasons(reasons);
    return reasons;
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
    both.stopped = both.stopped || right.stopped;
    if (both.proofs && right.proofs) *both.proofs += *right.proofs;
    both.seen.resize(std::max(both.seen.size(), right.seen.size()), 0);
    for (size_t i = 0; i < right.seen.size(); ++i) both.seen[i] |= right.seen[i];
    both.exactly_visible = static_cast<uint64_t>(std::count(both.seen.begin(), both.seen.end(), uint8_t{1}));
    return both;
}

}  // namespace sightline::cli
