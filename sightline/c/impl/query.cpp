// Queries of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/query.h"

#include <cstddef>
#include <cstdio>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/query_handle.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/query/record/frame_recorder.h"

using namespace sightline;
using c::fail;

slQuerySettings slDefaultQuerySettings(void) {
    const QuerySettings from;
    slQuerySettings to{};
    c::copySettings(from, to);
    to.windows = static_cast<slPortalWindows>(from.windows);
    to.cookie = c::kSettingsCookie;
    return to;
}

slStatus slCreateQuery(const slHooks* hooks, slQuery** query_out) {
    if (!query_out) return fail(hooks ? hooks->log : slLog{}, SL_BAD_ARGUMENT, __func__, "query_out is null");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    *query_out = c::makeHandle<slQuery>(c::shareHooks(hooks));
    return SL_OK;
}

void slDestroyQuery(slQuery* query) { c::destroyHandle(query); }

namespace {

slStatus failNull(const slQuery* query, const char* call) {
    return fail(query ? query->log() : slLog{}, SL_BAD_ARGUMENT, call, "a pointer is null");
}

/// Says once of what is wrong with the view of the last answer.
void noteProblem(slQuery& query, const char* call) {
    const ViewProblem problem = query.last.problem;
    if (problem != query.problem && problem != ViewProblem::kNone) {
        char sentence[200];
        std::snprintf(sentence, sizeof sentence, "nothing is culled: %s", wordsOf(problem));
        fail(query.log(), SL_BAD_ARGUMENT, call, sentence);
    }
    query.problem = problem;
}

const slVisibleLod* lodsOut(std::span<const VisibleLod> from) {
    static_assert(sizeof(slVisibleLod) == sizeof(VisibleLod) &&
                  offsetof(slVisibleLod, fade) == offsetof(VisibleLod, fade) &&
                  offsetof(slVisibleLod, morph) == offsetof(VisibleLod, morph));
    return from.empty() ? nullptr : reinterpret_cast<const slVisibleLod*>(from.data());
}

const slDrawRange* rangesOut(std::span<const DrawRange> from) {
    static_assert(sizeof(slDrawRange) == sizeof(DrawRange) &&
                  offsetof(slDrawRange, first) == offsetof(DrawRange, first) &&
                  offsetof(slDrawRange, part) == offsetof(DrawRange, part));
    return from.empty() ? nullptr : reinterpret_cast<const slDrawRange*>(from.data());
}

slStatus ask(slQuery* query, const slSnapshot* snapshot, const slView* view, const slQuerySettings* settings,
             const char* call) {
    if (!query || !snapshot) return failNull(query, call);
    View to;
    QuerySettings how;
    if (const slStatus status = c::toView(view, query->log(), call, to)) return status;
    if (const slStatus status = c::toSettings(settings, query->log(), call, how)) return status;
    const c::SharedHooks before = query->asked.exchange(snapshot->hooks);
    query->last = query->query.visible(snapshot->snapshot, to, how);
    query->objects = snapshot->snapshot.objectCount();
    noteProblem(*query, call);
    return SL_OK;
}

/// The last answer as the caller reads it.
slVisibleSet lastOf(const slQuery& query) {
    const VisibleSet& set = query.last;
    const bool used = set.problem == ViewProblem::kNone;
    return {c::visibles(set.objects),
            static_cast<uint32_t>(set.objects.size()),
            rangesOut(set.ranges),
            static_cast<uint32_t>(set.ranges.size()),
            lodsOut(set.lods),
            c::rects(set.scissors),
            used ? nullptr : wordsOf(set.problem)};
}

slStatus copyKeys(std::span<const Visible> from, uint64_t* keys_out, size_t capacity, size_t* count_out) {
    *count_out = from.size();
    const size_t fits = std::min(from.size(), capacity);
    for (size_t i = 0; i < fits; ++i) keys_out[i] = from[i].key;
    return fits < from.size() ? SL_NO_ROOM : SL_OK;
}

}  // namespace

slStatus slQueryVisible(slQuery* query, const slSnapshot* snapshot, const slView* view, const slQuerySettings* settings,
                        slVisibleSet* set_out) {
    if (!set_out) return failNull(query, __func__);
    if (const slStatus status = ask(query, snapshot, view, settings, __func__)) return status;
    *set_out = lastOf(*query);
    return SL_OK;
}

slStatus slQueryVisibleKeys(slQuery* query, const slSnapshot* snapshot, const slView* view,
                            const slQuerySettings* settings, uint64_t* keys_out, size_t capacity, size_t* count_out) {
    if (!count_out || (!keys_out && capacity > 0)) return failNull(query, __func__);
    if (const slStatus status = ask(query, snapshot, view, settings, __func__)) return status;
    return copyKeys(query->last.objects, keys_out, capacity, count_out);
}

slStatus slQueryKeys(const slQuery* query, uint64_t* keys_out, size_t capacity, size_t* count_out) {
    if (!query || !count_out || (!keys_out && capacity > 0)) return failNull(query, __func__);
    return copyKeys(query->last.objects, keys_out, capacity, count_out);
}

slStatus slQueryStereo(slQuery* query, const slSnapshot* snapshot, const slView* left, const slView* right,
                       const slQuerySettings* settings, slVisibleSet* set_out, const uint8_t** eyes_out) {
    if (!query || !snapshot || !set_out || !eyes_out) return failNull(query, __func__);
    View views[2];
    QuerySettings how;
    if (const slStatus status = c::toView(left, query->log(), __func__, views[0])) return status;
    if (const slStatus status = c::toView(right, query->log(), __func__, views[1])) return status;
    if (const slStatus status = c::toSettings(settings, query->log(), __func__, how)) return status;
    const c::SharedHooks before = query->asked.exchange(snapshot->hooks);
    const StereoSet set = query->query.visibleStereo(snapshot->snapshot, views[0], views[1], how);
    query->last = {};
    query->last.objects = set.objects;
    query->last.stats = set.left;
    query->last.stats.addWork(set.right);
    query->last.lods = set.lods;
    query->last.problem = set.left_problem != ViewProblem::kNone ? set.left_problem : set.right_problem;
    query->objects = snapshot->snapshot.objectCount();
    noteProblem(*query, __func__);
    *set_out = lastOf(*query);
    *eyes_out = set.eyes.data();
    return SL_OK;
}

slStatus slQueryPropose(slQuery* query, const slObjectId* ids, size_t count) {
    if (!query || (!ids && count > 0)) return failNull(query, __func__);
    static_assert(sizeof(slObjectId) == sizeof(ObjectId) &&
                  offsetof(slObjectId, generation) == offsetof(ObjectId, generation));
    query->query.propose({reinterpret_cast<const ObjectId*>(ids), count});
    return SL_OK;
}

slStatus slQueryLearn(slQuery* query, slQuery* teacher) {
    if (!query || !teacher) return failNull(query, __func__);
    query->query.learn(teacher->query);
    return SL_OK;
}

slStatus slQueryChanges(slQuery* query, slChanges* changes_out) {
    if (!query || !changes_out) return failNull(query, __func__);
    const VisibleChanges changes = query->query.changes();
    *changes_out = {c::visibles(changes.appeared), c::visibles(changes.disappeared),
                    static_cast<uint32_t>(changes.appeared.size()), static_cast<uint32_t>(changes.disappeared.size())};
    return SL_OK;
}

slStatus slQueryGetStats(const slQuery* query, slQueryStats* stats_out) {
    if (!query || !stats_out) return failNull(query, __func__);
    static_assert(SL_STAGE_COUNT == kStageCount);
    const QueryStats& from = query->last.stats;
    slQueryStats to{};
    for (int i = 0; i < kStageCount; ++i)
        to.stages[i] = {from.stages[i].tested, from.stages[i].culled, from.stages[i].doubt, from.stages[i].nanoseconds};
    to.objects = from.objects;
    to.visible = from.visible;
    to.nodes_visited = from.nodes_visited;
    to.occluder_triangles = from.occluder_triangles;
    to.unasked = from.unasked;
    to.proved = from.proved;
    to.second_looks = from.second_looks;
    to.nanoseconds = from.nanoseconds;
    to.budget_spent = from.budget_spent;
    to.second_look_spent = from.second_look_spent;
    to.off = from.off;
    *stats_out = to;
    return SL_OK;
}

const char* slOffWords(uint32_t bit) { return bit < std::size(kOffRows) ? kOffRows[bit].words : nullptr; }

slStatus slQueryReasons(const slQuery* query, uint8_t* reasons_out, size_t capacity, size_t* count_out) {
    if (!query || !count_out || (!reasons_out && capacity > 0)) return failNull(query, __func__);
    query->reasons.resize(query->objects);
    query->query.reasons(query->reasons);
    return c::copyOut<uint8_t>(query->reasons, reasons_out, capacity, count_out);
}

slStatus slQueryDepthImage(slQuery* query, slDepthImage* image_out) {
    if (!query || !image_out) return failNull(query, __func__);
    const Query::DepthImage image = query->query.depthImage();
    *image_out = {image.width, image.height, image.perspective, image.nearness.data(), image.covered.data()};
    return SL_OK;
}

slStatus slQueryRecord(slQuery* query, const void** bytes_out, size_t* count_out) {
    if (!query || !bytes_out || !count_out) return failNull(query, __func__);
    const Result<FrameRecording> recording = recordFrame(query->query, query->hooks->memory());
    if (!recording) return fail(query->log(), SL_BAD_ARGUMENT, __func__, recording.error().message.c_str());
    query->recorded = recordingBytes(*recording, query->hooks->memory());
    *bytes_out = query->recorded.data();
    *count_out = query->recorded.size();
    return SL_OK;
}
