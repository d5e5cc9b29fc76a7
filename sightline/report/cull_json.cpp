// What a cull along a camera path gave, as JSON: the schema sightline.cull/1.
// SPDX-License-Identifier: MIT
#include <cmath>

#include <nlohmann/json.hpp>

#include "sightline/report/camera_json.h"
#include "sightline/report/cull_run.h"

namespace sightline {
namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json verificationJson(const VerificationRow& verification, const FrameResult& frame, const Scene& scene) {
    Json out;
    out["false_culls"] = verification.false_culls;
    out["samples"] = verification.rays;
    out["aimed_samples"] = verification.aimed_rays;
    out["id_samples"] = verification.id_samples;
    out["supersampling"] = verification.supersampling;
    out["unconfirmed"] = verification.unconfirmed;
    out["exactly_visible"] = verification.exactly_visible;
    out["reported"] = frame.visible.size();
    if (verification.lossy_seen > 0) out["lossy_seen"] = verification.lossy_seen;
    out["list"] = Json::array();
    for (const FalseCullRow& row : verification.rows)
        out["list"].push_back({{"key", row.key},
                               {"name", scene.objects[row.object].name},
                               {"pixel", {row.x, row.y}},
                               {"witness", row.witness}});
    out["kept_unseen"] = keysKeptUnseen(frame, scene);
    return out;
}

Json frameJson(const FrameResult& frame, const CullRun& run, const Scene& scene) {
    Json out;
    out["camera"] = cameraJson(frame.camera);
    out["visible"] = frame.visible;
    if (run.stereo > 0) out["eyes"] = frame.eyes;
    out["stages"] = Json::array();
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(run.stages >> stage & 1)) continue;
        const StageRow& row = frame.stages[stage];
        out["stages"].push_back({{"name", kStageNames[stage]},
                                 {"tested", row.tested},
                                 {"culled", row.culled},
                                 {"doubt", row.doubt},
                                 {"microseconds", row.microseconds}});
    }
    if (frame.changed_pixels) out["changed_pixels"] = *frame.changed_pixels;
    out["triangles"] = frame.triangles;
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
    out["occluder_triangles"] = frame.occluder_triangles;
    out["nodes_visited"] = frame.nodes_visited;
    out["seam_pixels"] = frame.seam_pixels;
    if (frame.closed_gaps > 0) out["closed_gaps"] = frame.closed_gaps;
    out["budget_spent"] = frame.budget_spent;
    out["faces_tested"] = frame.faces_tested;
    out["faces_culled"] = frame.faces_culled;
    out["second_looks"] = frame.second_looks;
    out["second_look_culled"] = frame.second_look_culled;
    out["second_look_polygons"] = frame.second_look_polygons;
    out["second_look_spent"] = frame.second_look_spent;
    out["query_microseconds"] = frame.query_microseconds;
    out["thread"] = frame.thread;
    out["begin_microseconds"] = frame.begin_microseconds;
    out["end_microseconds"] = frame.end_microseconds;
    if (frame.verification) out["verification"] = verificationJson(*frame.verification, frame, scene);
    return out;
}

Json visibilityJson(const VisibilityAsked& asked) {
    Json out;
    out["file"] = asked.file;
    out["windows"] = asked.windows;
    if (asked.portal_depth > 0) out["portal_depth"] = asked.portal_depth;
    for (const DoorAsked& door : asked.doors) out["doors"].push_back({{"name", door.name}, {"open", door.open}});
    return out;
}

Json headJson(const CullRun& run, const Scene& scene) {
    Json head;
    head["schema"] = "sightline.cull/1";
    head["scene"] = {
        {"file", run.scene}, {"objects", run.objects}, {"instances", run.instances}, {"triangles", run.triangles}};
    if (scene.files.size() > 1) {
        Json files = Json::array();
        for (const SceneFile& file : scene.files) files.push_back({{"file", file.name}, {"first_key", file.first_key}});
        head["scene"]["files"] = std::move(files);
    }
    head["width"] = run.width;
    head["height"] = run.height;
    head["jitter"] = run.jitter;
    head["occluder_triangles_limit"] = run.occluder_triangles;
    if (run.occluder_error > 0) head["occluder_error"] = run.occluder_error;
    if (run.max_distance > 0) head["max_distance"] = run.max_distance;
    if (run.contribution > 0) head["contribution"] = run.contribution;
    if (run.hysteresis > 0) head["hysteresis"] = run.hysteresis;
    for (const glm::dvec4& plane : run.sections.all()) head["sections"].push_back({plane.x, plane.y, plane.z, plane.w});
    if (!run.visibility.file.empty()) head["visibility"] = visibilityJson(run.visibility);
    if (run.stages & stageBit(Stage::kClusters)) head["cluster_test"] = run.cluster_test;
    if (run.stereo > 0) head["stereo"] = run.stereo;
    if (run.last_visible_first) head["last_visible_first"] = true;
    head["occlusion_size"] = run.occlusion_size;
    head["faces"] = run.faces;
    if (run.masked) head["masked"] = true;
    if (run.close_gaps > 0) head["close_gaps"] = run.close_gaps;
    head["second_look"] = run.second_look;
    head["second_look_polygons_limit"] = run.second_look_polygons;
    if (run.bins != View().bins) head["bins"] = run.bins;
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
    if (sum.lossy_seen > 0) out["lossy_seen"] = sum.lossy_seen;
    out["culled"] = sum.culled;
    out["over_estimate"] = std::isfinite(sum.overEstimate()) ? Json(sum.overEstimate()) : Json(nullptr);
    return out;
}

}  // namespace

std::string cullJson(const CullRun& run, const Scene& scene) {
    std::string text = dump(headJson(run, scene));
    text.pop_back();
    text += ",\n\"frames\": [";
    for (size_t i = 0; i < run.frames.size(); ++i)
        text += (i ? ",\n" : "\n") + dump(frameJson(run.frames[i], run, scene));
    text += "],\n\"objects\": [";
    const char* between = "\n";
    for (const KeyName& name : keyNames(run, scene, orderByKey(scene))) {
        text += between + dump({{"key", name.key}, {"name", name.name}, {"path", name.path}});
        between = ",\n";
    }
    text += "]";
    if (const auto changes = sumChanges(run))
        text += ",\n\"changes\": " + dump({{"changed_pixels", changes->changed}, {"pixels", changes->pixels}});
    if (const auto sum = sumVerification(run)) text += ",\n\"verification\": " + dump(sumsJson(*sum));
    return text + "}\n";
}

}  // namespace sightline
