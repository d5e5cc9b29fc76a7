// What a cull along a camera path gave, as JSON: the schema sightline.cull/1.
// SPDX-License-Identifier: MIT
#include <cmath>

#include <nlohmann/json.hpp>

#include "sightline/geom/setting_rows.h"
#include "sightline/tools/report/run/camera_json.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

Json proofsJson(const ProofCounts& proofs) {
    return {{"culled_hidden", proofs.culled_hidden},
            {"culled_undecided", proofs.culled_undecided},
            {"kept_hidden", proofs.kept_hidden},
            {"kept_undecided", proofs.kept_undecided}};
}

/// @param scene  whose objects are listed; null: they are left out
Json verificationJson(const VerificationRow& verification, const FrameResult& frame, const Scene* scene) {
    Json out;
    out["false_culls"] = verification.false_culls;
    out["samples"] = verification.rays;
    out["aimed_samples"] = verification.aimed_rays;
    out["id_samples"] = verification.id_samples;
    out["supersampling"] = verification.supersampling;
    out["unconfirmed"] = verification.unconfirmed;
    if (verification.proofs) out["proofs"] = proofsJson(*verification.proofs);
    out["exactly_visible"] = verification.exactly_visible;
    out["reported"] = frame.visible.size();
    if (verification.lossy_seen > 0) out["lossy_seen"] = verification.lossy_seen;
    if (!scene) return out;
    out["list"] = Json::array();
    for (const FalseCullRow& row : verification.rows)
        out["list"].push_back({{"key", row.key},
                               {"name", scene->objects[row.object].name},
                               {"pixel", {row.x, row.y}},
                               {"witness", row.witness}});
    out["kept_unseen"] = keysKeptUnseen(frame, *scene);
    return out;
}

/// @param scene  whose objects are listed; null: those that are kept are counted
Json frameJson(const FrameResult& frame, const CullRun& run, const Scene* scene) {
    Json out;
    out["camera"] = cameraJson(frame.camera);
    if (scene) out["visible"] = frame.visible;
    else out["kept"] = frame.visible.size();
    out["instances"] = frame.objects_visible;
    if (scene && run.stereo > 0) out["eyes"] = frame.eyes;
    if (scene && !frame.lods.empty()) out["lods"] = lodsByKey(frame, *scene);
    if (!scene && !frame.notes.empty()) out["notes"] = frame.notes;
    out["stages"] = Json::array();
    for (const Stage stage : kStageOrder) {
        if (!(countedStages(run.settings.stages) & stageBit(stage))) continue;
        const StageRow& row = frame.stages[static_cast<int>(stage)];
        out["stages"].push_back({{"name", kStageNames[static_cast<int>(stage)]},
                                 {"tested", row.tested},
                                 {"culled", row.culled},
                                 {"instances", row.instances},
                                 {"doubt", row.doubt},
                                 {"microseconds", row.microseconds}});
    }
    if (frame.changed_pixels) out["changed_pixels"] = *frame.changed_pixels;
    out["triangles"] = frame.triangles;
    if (frame.frustum_alone)
        out["frustum_alone"] = {{"objects", frame.frustum_alone->objects},
                                {"triangles", frame.frustum_alone->triangles}};
    if (frame.clusters) {
        const ClusterRow& row = *frame.clusters;
        out["clusters"] = {{"tested", row.tested}, {"back", row.back},   {"outside", row.outside},
                           {"hidden", row.hidden}, {"whole", row.whole}, {"drawn", row.drawn},
                           {"draws", row.draws}};
    }
    if (frame.cells)
        out["cells"] = {{"known", frame.cells->known},
                        {"entered", frame.cells->cells},
                        {"portals", frame.cells->portals},
                        {"whole", frame.cells->whole},
                        {"too_deep", frame.cells->too_deep}};
    for (const CounterRow& row : kQueryCounters) {
        const bool rare = row.kind == CounterRow::kRare && frame.stats.*row.member > 0;
        const bool work = row.kind == CounterRow::kWork && row.member != &QueryStats::nanoseconds;
        if (rare || work) out[row.name] = frame.stats.*row.member;
    }
    for (const CounterFlagRow& row : kQueryFlags) out[row.name] = frame.stats.*row.member;
    for (const OffRow& row : kOffRows)
        if (frame.stats.off & offBit(row.off)) out["off"].push_back(row.name);
    if (scene && !run.scene_hash.empty()) {
        out["certificates"] = Json::array();
        for (const CertificateRow& row : frame.certificates)
            out["certificates"].push_back({{"hiders", row.hiders}, {"hidden", row.hidden}});
    }
    out["query_microseconds"] = frame.query_microseconds;
    out["thread"] = frame.thread;
    out["begin_microseconds"] = frame.begin_microseconds;
    out["end_microseconds"] = frame.end_microseconds;
    if (frame.verification) out["verification"] = verificationJson(*frame.verification, frame, scene);
    return out;
}

Json visibilityJson(const CullRun& run) {
    const VisibilityAsked& asked = run.visibility;
    Json out;
    out["file"] = asked.file;
    out["windows"] = kWindowNames[static_cast<int>(run.settings.windows)];
    if (run.settings.portal_depth > 0) out["portal_depth"] = run.settings.portal_depth;
    for (const DoorAsked& door : asked.doors) out["doors"].push_back({{"name", door.name}, {"open", door.open}});
    return out;
}

Json settingJson(PortalWindows windows) { return kWindowNames[static_cast<int>(windows)]; }
template <class Value>
Json settingJson(Value value) {
    return value;
}

/// Whether a row is of this member; rows are of several types.
template <class A, class B>
bool isMember(A a, B b) {
    if constexpr (std::is_same_v<A, B>) return a == b;
    else return false;
}

Json headJson(const CullRun& run, const Scene* scene) {
    Json head;
    head["schema"] = "sightline.cull/1";
    head["scene"] = {
        {"file", run.scene}, {"objects", run.objects}, {"instances", run.instances}, {"triangles", run.triangles}};
    if (!run.scene_hash.empty()) head["scene"]["hash"] = run.scene_hash;
    if (scene && scene->files.size() > 1) {
        Json files = Json::array();
        for (const SceneFile& file : scene->files)
            files.push_back({{"file", file.name}, {"first_key", file.first_key}});
        head["scene"]["files"] = std::move(files);
    }
    head["width"] = run.width;
    head["height"] = run.height;
    head["jitter"] = run.jitter;
    forEachSetting([&](const auto& row) {
        if (!isMember(row.member, &QuerySettings::stages)) head[row.name] = settingJson(run.settings.*row.member);
    });
    for (const glm::dvec4& plane : run.sections.all()) head["sections"].push_back({plane.x, plane.y, plane.z, plane.w});
    if (!run.visibility.file.empty()) head["visibility"] = visibilityJson(run);
    if (run.settings.stages & stageBit(Stage::kClusters)) head["cluster_test"] = run.cluster_test;
    if (run.stereo > 0) head["stereo"] = run.stereo;
    head["repeat"] = run.repeat;
    if (run.interrupted) {
        head["interrupted"] = true;
        head["frames_wanted"] = run.frames_wanted;
    }
    return head;
}

Json sumsJson(const Verification& sum) {
    Json out;
    out["false_culls"] = sum.false_culls;
    out["samples"] = sum.rays;
    out["exactly_visible"] = sum.exactly_visible;
    out["reported"] = sum.reported;
    out["aimed_samples"] = sum.aimed_rays;
    out["id_samples"] = sum.id_samples;
    out["unconfirmed"] = sum.unconfirmed;
    if (sum.proofs) out["proofs"] = proofsJson(*sum.proofs);
    if (sum.lossy_seen > 0) out["lossy_seen"] = sum.lossy_seen;
    out["culled"] = sum.culled;
    out["culled_instances"] = sum.culled_instances;
    out["false_instances"] = sum.false_instances;
    out["over_estimate"] = std::isfinite(sum.overEstimate()) ? Json(sum.overEstimate()) : Json(nullptr);
    return out;
}

std::string framesJson(const CullRun& run, const Scene* scene) {
    std::string text = jsonText(headJson(run, scene));
    text.pop_back();
    text += ",\n\"frames\": [";
    for (size_t i = 0; i < run.frames.size(); ++i)
        text += (i ? ",\n" : "\n") + jsonText(frameJson(run.frames[i], run, scene));
    return text + "]";
}

std::string totalsJson(const CullRun& run) {
    std::string text;
    if (const auto changes = sumChanges(run))
        text += ",\n\"changes\": " + jsonText(Json{{"changed_pixels", changes->changed}, {"pixels", changes->pixels}});
    if (const auto sum = sumVerification(run)) text += ",\n\"verification\": " + jsonText(sumsJson(*sum));
    return text + "}\n";
}

}  // namespace

std::string cullJson(const CullRun& run, const Scene& scene) {
    std::string text = framesJson(run, &scene) + ",\n\"objects\": [";
    const char* between = "\n";
    for (const KeyName& name : keyNames(run, scene, orderByKey(scene))) {
        text += between + jsonText(Json{{"key", name.key}, {"name", name.name}, {"path", name.path}});
        between = ",\n";
    }
    return text + "]" + totalsJson(run);
}

std::string cullJsonWithoutSets(const CullRun& run) { return framesJson(run, nullptr) + totalsJson(run); }

}  // namespace sightline::tools
