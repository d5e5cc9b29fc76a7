// What a whole path tells of a scene: who hides most, what is never seen, what comes and goes together.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/insight.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <unordered_map>

#include "sightline/base/random.h"
#include "sightline/math/curves.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr uint64_t kFewTriangles = 2000;  // of one object that is worth merging
constexpr double kNothing = 0.005;        // object-frames: what rounding leaves of none
constexpr double kSmallGroup = 0.05;      // its box, of the scene's diagonal: what is merged is culled as one

uint64_t trianglesOf(const Scene& scene, uint32_t object) {
    return scene.meshes[scene.objects[object].mesh].triangles();
}

/// In which frames an object was kept, as one number: equal sets have equal ones, others all but surely not.
struct KeptIn {
    uint64_t low = 0, high = 0;
    uint64_t frames = 0;
    bool operator==(const KeptIn&) const = default;
};

std::vector<KeptIn> keptIn(const CullRun& run, size_t objects) {
    std::vector<KeptIn> kept(objects);
    for (size_t i = 0; i < run.frames.size(); ++i) {
        const uint64_t low = mixSeed(1, i), high = mixSeed(2, i);
        const std::vector<uint8_t>& reasons = run.frames[i].reasons;
        for (size_t object = 0; object < std::min(objects, reasons.size()); ++object) {
            if (reasons[object] != 0) continue;
            kept[object].low += low;
            kept[object].high += high;
            ++kept[object].frames;
        }
    }
    return kept;
}

/// A small object, and what it must share with its neighbours in the list to be merged with them.
struct Mergeable {
    uint32_t object = 0;
    uint32_t parent = SceneNode::kNone;
    uint64_t place = 0;
    Box3d box;
};

std::vector<Mergeable> mergeable(const Scene& scene, const std::vector<KeptIn>& kept, const Box3d& world) {
    std::vector<Mergeable> list;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const Mesh& mesh = scene.meshes[object.mesh];
        if (kept[i].frames == 0 || mesh.deforms || mesh.triangles() > kFewTriangles) continue;
        const Box3d box = transformBox(mesh.bounds, object.transform);
        if (!box.finite()) continue;
        const uint32_t parent = object.node == SceneNode::kNone ? object.node : scene.nodes[object.node].parent;
        list.push_back({i, parent, mortonCode(box.center(), world), box});
    }
    std::sort(list.begin(), list.end(), [&](const Mergeable& a, const Mergeable& b) {
        if (a.parent != b.parent) return a.parent < b.parent;
        const KeptIn &ka = kept[a.object], &kb = kept[b.object];
        if (ka.low != kb.low) return ka.low < kb.low;
        if (ka.high != kb.high) return ka.high < kb.high;
        return a.place != b.place ? a.place < b.place : a.object < b.object;
    });
    return list;
}

}  // namespace

std::vector<OccluderRow> occluderRows(const CullRun& run) {
    std::vector<OccluderRow> rows;
    std::unordered_map<uint32_t, size_t> row_of;
    for (const FrameResult& frame : run.frames)
        for (const OccluderCredit& credit : frame.credits) {
            const auto [at, is_new] = row_of.try_emplace(credit.object, rows.size());
            if (is_new) rows.push_back({credit.object});
            OccluderRow& row = rows[at->second];
            ++row.frames;
            row.triangles += credit.triangles;
            row.hidden += credit.hidden;
            row.hidden_triangles += credit.hidden_triangles;
        }
    std::sort(rows.begin(), rows.end(), [](const OccluderRow& a, const OccluderRow& b) {
        return a.hidden != b.hidden ? a.hidden > b.hidden : a.object < b.object;
    });
    return rows;
}

double worthOf(const OccluderRow& row) {
    return row.triangles ? row.hidden_triangles / static_cast<double>(row.triangles) : 0.0;
}

std::vector<OccluderRow> payingRows(const std::vector<OccluderRow>& rows) {
    std::vector<OccluderRow> out;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(out),
                 [](const OccluderRow& row) { return row.hidden >= kNothing; });
    std::stable_sort(out.begin(), out.end(),
                     [](const OccluderRow& a, const OccluderRow& b) { return worthOf(a) > worthOf(b); });
    return out;
}

std::vector<OccluderRow> idleRows(const std::vector<OccluderRow>& rows) {
    std::vector<OccluderRow> out;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(out),
                 [](const OccluderRow& row) { return row.hidden < kNothing; });
    std::stable_sort(out.begin(), out.end(),
                     [](const OccluderRow& a, const OccluderRow& b) { return a.triangles > b.triangles; });
    return out;
}

std::vector<uint32_t> neverKept(const CullRun& run, const Scene& scene) {
    std::vector<uint32_t> never;
    const std::vector<KeptIn> kept = keptIn(run, scene.objects.size());
    for (uint32_t i = 0; i < kept.size(); ++i)
        if (kept[i].frames == 0) never.push_back(i);
    std::stable_sort(never.begin(), never.end(),
                     [&](uint32_t a, uint32_t b) { return trianglesOf(scene, a) > trianglesOf(scene, b); });
    return never;
}

std::vector<TogetherGroup> keptTogether(const CullRun& run, const Scene& scene) {
    const std::vector<KeptIn> kept = keptIn(run, scene.objects.size());
    const Box3d world = coreOf(scene).bounds;
    const double largest = kSmallGroup * glm::length(world.size());
    const std::vector<Mergeable> list = mergeable(scene, kept, world);
    std::vector<TogetherGroup> groups;
    for (size_t first = 0, last = 0; first < list.size(); first = last) {
        TogetherGroup group;
        Box3d box;
        for (; last < list.size(); ++last) {
            const Mergeable& next = list[last];
            Box3d with = box;
            with.grow(next.box);
            if (last > first && (next.parent != list[first].parent || kept[next.object] != kept[list[first].object] ||
                                 !(glm::length(with.size()) <= largest)))
                break;
            box = with;
            group.objects.push_back(next.object);
            group.triangles += trianglesOf(scene, next.object);
        }
        if (group.objects.size() < 2) continue;
        group.frames = kept[group.objects.front()].frames;
        std::sort(group.objects.begin(), group.objects.end());
        groups.push_back(std::move(group));
    }
    std::sort(groups.begin(), groups.end(), [](const TogetherGroup& a, const TogetherGroup& b) {
        if (a.objects.size() != b.objects.size()) return a.objects.size() > b.objects.size();
        return a.objects.front() < b.objects.front();
    });
    return groups;
}

}  // namespace sightline::tools
