// What a cull along a camera path gave, as plain data, and its JSON form.
// SPDX-License-Identifier: MIT
#include "sightline/report/cull_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "sightline/report/camera_json.h"

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
    out["list"] = Json::array();
    for (const FalseCullRow& row : verification.rows)
        out["list"].push_back({{"key", row.key},
                               {"name", scene.objects[row.object].name},
                               {"pixel", {row.x, row.y}},
                               {"witness", row.witness}});
    return out;
}

Json frameJson(const FrameResult& frame, const CullRun& run, const Scene& scene) {
    Json out;
    out["camera"] = cameraJson(frame.camera);
    out["visible"] = frame.visible;
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
    out["triangles"] = frame.triangles;
    out["occluder_triangles"] = frame.occluder_triangles;
    out["budget_spent"] = frame.budget_spent;
    out["query_microseconds"] = frame.query_microseconds;
    if (frame.verification) out["verification"] = verificationJson(*frame.verification, frame, scene);
    return out;
}

}  // namespace

double Verification::overEstimate() const {
    if (exactly_visible == 0) return reported == 0 ? 1.0 : std::numeric_limits<double>::infinity();
    return static_cast<double>(reported) / static_cast<double>(exactly_visible);
}

std::optional<Verification> sumVerification(const CullRun& run) {
    std::optional<Verification> sum;
    for (const FrameResult& frame : run.frames) {
        if (!frame.verification) continue;
        const VerificationRow& row = *frame.verification;
        if (!sum) {
            sum.emplace();
            sum->least_supersampling = row.supersampling;
        }
        sum->false_culls += row.false_culls;
        sum->rays += row.rays;
        sum->aimed_rays += row.aimed_rays;
        sum->id_samples += row.id_samples;
        sum->unconfirmed += row.unconfirmed;
        sum->least_supersampling = std::min(sum->least_supersampling, row.supersampling);
        sum->most_supersampling = std::max(sum->most_supersampling, row.supersampling);
        sum->exactly_visible += row.exactly_visible;
        sum->reported += frame.visible.size();
        sum->culled += run.objects - frame.visible.size();
    }
    return sum;
}

std::vector<uint32_t> orderByKey(const Scene& scene) {
    std::vector<uint32_t> order(scene.objects.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return scene.objects[a].key < scene.objects[b].key; });
    return order;
}

uint64_t countKeys(const Scene& scene, const std::vector<uint32_t>& key_order) {
    uint64_t count = 0;
    for (size_t i = 0; i < key_order.size(); ++i)
        count += i == 0 || scene.objects[key_order[i]].key != scene.objects[key_order[i - 1]].key;
    return count;
}

void countByKey(const Scene& scene, const std::vector<uint32_t>& key_order, uint32_t stages, FrameResult& frame) {
    frame.visible.clear();
    frame.objects_visible = frame.triangles = 0;
    uint64_t keys = 0;
    for (size_t i = 0; i < key_order.size();) {
        const uint64_t key = scene.objects[key_order[i]].key;
        bool visible = false;
        uint8_t finest = 0;
        for (; i < key_order.size() && scene.objects[key_order[i]].key == key; ++i) {
            const uint8_t reason = frame.reasons[key_order[i]];
            finest = std::max(finest, reason);
            if (reason != 0) continue;
            visible = true;
            ++frame.objects_visible;
            frame.triangles += scene.meshes[scene.objects[key_order[i]].mesh].triangles();
        }
        ++keys;
        if (visible) frame.visible.push_back(key);
        else if (finest <= kStageCount) ++frame.stages[finest - 1].culled;
    }
    uint64_t left = keys;
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(stages >> stage & 1)) continue;
        frame.stages[stage].tested = left;
        left -= frame.stages[stage].culled;
    }
}

std::string cullJson(const CullRun& run, const Scene& scene) {
    Json head;
    head["schema"] = "sightline.cull/1";
    head["scene"] = {
        {"file", run.scene}, {"objects", run.objects}, {"instances", run.instances}, {"triangles", run.triangles}};
    head["width"] = run.width;
    head["height"] = run.height;
    head["jitter"] = run.jitter;
    head["repeat"] = run.repeat;
    std::string text = dump(head);
    text.pop_back();
    text += ",\n\"frames\": [";
    for (size_t i = 0; i < run.frames.size(); ++i)
        text += (i ? ",\n" : "\n") + dump(frameJson(run.frames[i], run, scene));
    text += "]";
    if (const auto sum = sumVerification(run)) {
        Json verification;
        verification["false_culls"] = sum->false_culls;
        verification["samples"] = sum->rays;
        verification["exactly_visible"] = sum->exactly_visible;
        verification["reported"] = sum->reported;
        verification["aimed_samples"] = sum->aimed_rays;
        verification["id_samples"] = sum->id_samples;
        verification["unconfirmed"] = sum->unconfirmed;
        verification["culled"] = sum->culled;
        verification["over_estimate"] = std::isfinite(sum->overEstimate()) ? Json(sum->overEstimate()) : Json(nullptr);
        text += ",\n\"verification\": " + dump(verification);
    }
    return text + "}\n";
}

}  // namespace sightline
