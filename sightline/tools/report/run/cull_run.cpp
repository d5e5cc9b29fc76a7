// What a cull along a camera path gave, counted and summed.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/cull_run.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace sightline::tools {

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
        sum->lossy_seen += row.lossy_seen;
        if (row.proofs) (sum->proofs ? *sum->proofs : sum->proofs.emplace()) += *row.proofs;
        sum->least_supersampling = std::min(sum->least_supersampling, row.supersampling);
        sum->most_supersampling = std::max(sum->most_supersampling, row.supersampling);
        sum->exactly_visible += row.exactly_visible;
        sum->reported += frame.visible.size();
        sum->culled += run.objects - frame.visible.size();
        sum->culled_instances += run.instances - frame.objects_visible;
        sum->false_instances += row.rows.size();
    }
    return sum;
}

std::optional<Changes> sumChanges(const CullRun& run) {
    std::optional<Changes> sum;
    for (const FrameResult& frame : run.frames) {
        if (!frame.changed_pixels) continue;
        if (!sum) sum.emplace();
        sum->changed += *frame.changed_pixels;
        sum->pixels += uint64_t{run.width} * run.height;
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
    frame.eyes.clear();
    const bool two_eyes = !frame.eye_reasons[0].empty();
    frame.objects_visible = frame.triangles = 0;
    uint64_t keys = 0;
    for (size_t i = 0; i < key_order.size();) {
        const uint64_t key = scene.objects[key_order[i]].key;
        bool visible = false;
        uint8_t finest = 0, eyes = 0;
        for (; i < key_order.size() && scene.objects[key_order[i]].key == key; ++i) {
            const uint8_t reason = frame.reasons[key_order[i]];
            finest = std::max(finest, reason);
            for (int eye = 0; two_eyes && eye < 2; ++eye)
                eyes |= static_cast<uint8_t>((frame.eye_reasons[eye][key_order[i]] == 0) << eye);
            if (reason > 0 && reason <= kStageCount) ++frame.stages[reason - 1].instances;
            if (reason != 0) continue;
            visible = true;
            ++frame.objects_visible;
            frame.triangles += scene.meshes[scene.objects[key_order[i]].mesh].triangles();
        }
        ++keys;
        if (visible && two_eyes) frame.eyes.push_back(eyes);
        if (visible) frame.visible.push_back(key);
        else if (finest <= kStageCount) ++frame.stages[finest - 1].culled;
    }
    if (frame.clusters) frame.triangles -= frame.clusters->whole - frame.clusters->drawn;
    frame.triangles -= frame.stats.lod_finest;
    frame.triangles += frame.stats.lod_triangles;
    uint64_t left = keys;
    for (const Stage at : kStageOrder) {
        if (!(countedStages(stages) & stageBit(at))) continue;
        StageRow& row = frame.stages[static_cast<int>(at)];
        row.tested = left;
        left -= row.culled;
    }
}

std::vector<uint8_t> lodsByKey(const FrameResult& frame, const Scene& scene) {
    if (frame.lods.empty()) return {};
    std::vector<uint8_t> lods(frame.visible.size(), 0xff);
    for (size_t i = 0; i < frame.lods.size(); ++i) {
        if (frame.reasons[i] != 0) continue;
        const auto at = std::lower_bound(frame.visible.begin(), frame.visible.end(), scene.objects[i].key);
        uint8_t& level = lods[static_cast<size_t>(at - frame.visible.begin())];
        level = std::min(level, frame.lods[i]);
    }
    return lods;
}

std::vector<uint64_t> keysKeptUnseen(const FrameResult& frame, const Scene& scene) {
    std::vector<uint64_t> unseen, seen;
    if (!frame.verification) return unseen;
    const std::vector<uint32_t>& objects = frame.verification->kept_unseen;
    for (const uint32_t object : objects) unseen.push_back(scene.objects[object].key);
    for (uint32_t i = 0; i < frame.reasons.size() && !objects.empty(); ++i)
        if (frame.reasons[i] == 0 && !std::binary_search(objects.begin(), objects.end(), i))
            seen.push_back(scene.objects[i].key);
    std::sort(unseen.begin(), unseen.end());
    unseen.erase(std::unique(unseen.begin(), unseen.end()), unseen.end());
    std::sort(seen.begin(), seen.end());
    std::erase_if(unseen, [&](uint64_t key) { return std::binary_search(seen.begin(), seen.end(), key); });
    return unseen;
}

std::vector<KeyName> keyNames(const CullRun& run, const Scene& scene, const std::vector<uint32_t>& key_order) {
    std::vector<uint64_t> wanted;
    for (const FrameResult& frame : run.frames) {
        wanted.insert(wanted.end(), frame.visible.begin(), frame.visible.end());
        if (frame.verification)
            for (const FalseCullRow& row : frame.verification->rows) wanted.push_back(row.key);
        if (wanted.size() < (size_t{1} << 22)) continue;  // a long path would pile them up
        std::sort(wanted.begin(), wanted.end());
        wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::vector<KeyName> names;
    names.reserve(wanted.size());
    size_t at = 0;
    for (const uint64_t key : wanted) {
        while (at < key_order.size() && scene.objects[key_order[at]].key < key) ++at;
        if (at == key_order.size()) break;
        const SceneObject& object = scene.objects[key_order[at]];
        if (object.key == key) names.push_back({key, object.name, objectPath(scene, object)});
    }
    return names;
}

}  // namespace sightline::tools
