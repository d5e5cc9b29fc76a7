// Why one object is kept or culled, along a path: for a reader, and as JSON.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/explain_object.h"

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/core.h>
#include <glm/gtc/matrix_access.hpp>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/explain_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/suggestion.h"
#include "sightline/tools/truth/cull_proof.h"
#include "sightline/tools/truth/verify.h"

namespace sightline::cli {
using namespace tools;
namespace {

constexpr size_t kLongestCall = 200;  // of a path, in sentences  [bytes]

/// The objects of which a test holds, if they have one key; else empty, and `keys` has all of theirs.
template <class Test>
std::vector<uint32_t> withOneKey(const Scene& scene, Test test, std::set<uint64_t>& keys) {
    keys.clear();
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (!test(scene.objects[i])) continue;
        found.push_back(i);
        keys.insert(scene.objects[i].key);
    }
    if (keys.size() > 1) found.clear();
    return found;
}

Error ambiguous(const Scene& scene, const std::string& word, const std::set<uint64_t>& keys) {
    constexpr size_t kMost = 10;
    std::string list;
    std::set<uint64_t> listed;
    for (uint32_t i = 0; i < scene.objects.size() && listed.size() < kMost; ++i) {
        const uint64_t key = scene.objects[i].key;
        if (!keys.count(key) || !listed.insert(key).second) continue;
        list += fmt::format("{}{} '{}'", list.empty() ? "" : ", ", key,
                            oneLine(objectPath(scene, scene.objects[i]), kLongestCall));
    }
    if (keys.size() > kMost) list += ", ...";
    return {Error::Kind::kUsage,
            fmt::format("--object {}: {} objects are called so: {}; --at X,Y asks a pixel", word, keys.size(), list)};
}

/// The view through one pixel alone.
View throughPixel(const View& view, uint32_t x, uint32_t y) {
    View pixel = view;
    const double centre_x = 2.0 * (x + 0.5) / view.width - 1.0, centre_y = 1.0 - 2.0 * (y + 0.5) / view.height;
    glm::dmat4 pick(1.0);
    pick[0][0] = view.width;
    pick[1][1] = view.height;
    pick[3][0] = -centre_x * view.width;
    pick[3][1] = -centre_y * view.height;
    pixel.projection = pick * view.projection;
    pixel.width = pixel.height = 1;
    pixel.jitter = 0;
    return pixel;
}

/// The material of a triangle.
const Material& materialOf(const Scene& scene, const ProbeHit& hit) {
    const Mesh& mesh = scene.meshes[scene.objects[hit.object].mesh];
    for (const Primitive& part : mesh.primitives)
        if (hit.triangle >= part.first_triangle && hit.triangle - part.first_triangle < part.triangle_count)
            return scene.materials[part.material];
    return scene.materials[mesh.primitives.front().material];
}

/// Adds what shines through at the middle of a pixel: objects that are not yet among the layers.
void addClear(const Scene& scene, const View& pixel, std::vector<Layer>& layers) {
    constexpr int kMostHits = 4096;
    const glm::dmat4 back = glm::inverse(pixel.projection * pixel.view);
    const glm::dvec4 begin = back * glm::dvec4(0, 0, -1, 1), end = back * glm::dvec4(0, 0, 0.5, 1);
    const glm::dvec3 from = glm::dvec3(begin) / begin.w, to = glm::dvec3(end) / end.w;
    const glm::dvec3 along = -glm::dvec3(glm::row(pixel.view, 2));
    const ProbeRay ray{from, glm::normalize(to - from)};
    const glm::dvec3 eye = eyePosition(pixel);
    const RayProbe probe(scene);
    double at = 0;
    for (int i = 0; i < kMostHits; ++i) {
        const std::optional<ProbeHit> hit = probe.nearest(ray, at);
        if (!hit) return;
        at = hit->t;
        const Material& material = materialOf(scene, *hit);
        if (material.hides() || (!hit->front && !material.double_sided)) continue;
        const double depth = glm::dot(along, ray.origin + at * ray.direction - eye);
        const auto known = [&](const Layer& layer) { return layer.object == hit->object; };
        if (std::none_of(layers.begin(), layers.end(), known)) layers.push_back({hit->object, depth, true});
    }
}

using Json = nlohmann::ordered_json;

constexpr size_t kColumns = 100;

Json objectJson(const Scene& scene, uint32_t object) {
    return {{"key", scene.objects[object].key},
            {"name", scene.objects[object].name},
            {"path", objectPath(scene, scene.objects[object])}};
}

Json hidersJson(const AskedScene& asked, const Array<Hider>& hiders) {
    Json list = Json::array();
    for (const Hider& hider : hiders) {
        Json row = objectJson(asked.scene, AskedScene::objectOf(hider.id));
        row["share"] = hider.share;
        list.push_back(row);
    }
    return list;
}

Json shadowsJson(const AskedScene& asked, const std::vector<ShadowCaster>& shadows) {
    Json list = Json::array();
    for (const ShadowCaster& caster : shadows) {
        list.push_back(objectJson(asked.scene, caster.object));
        for (const glm::dvec3& corner : caster.outline)
            list.back()["outline"].push_back({corner.x, corner.y, corner.z});
    }
    return list;
}

/// What of an object was asked when its fate was decided.
const char* askedName(bool by_faces, bool by_triangles) {
    return by_triangles ? "triangles" : by_faces ? "faces" : "rectangle";
}

Json frustumJson(const FrustumReason& reason) {
    Json out;
    out["plane"] = kPlaneNames[reason.plane];
    out["distance"] = reason.distance();
    for (uint32_t plane = 0; plane < FrustumReason::kPlanes; ++plane)
        if (reason.outside[plane] != FrustumReason::kNoPlane)
            out["outside"][kPlaneNames[plane]] = reason.outside[plane];
    out["by_rectangle"] = reason.by_rectangle;
    out["by_faces"] = reason.by_faces;
    out["by_triangles"] = reason.by_triangles;
    return out;
}

Json occlusionJson(const AskedScene& asked, const OcclusionReason& reason) {
    constexpr const char* kWithout[] = {"not asked", "visible",   "occluded",  "outside frustum",
                                        "too far",   "too small", "faces away"};
    Json out;
    out["occluders"] = hidersJson(asked, reason.hiders);
    if (reason.stage == Stage::kOcclusion) out["asked"] = askedName(reason.by_faces, reason.by_triangles);
    out["sufficient"] = reason.sufficient;
    out["outside_too"] = reason.outside_too;
    out["without"] = kWithout[static_cast<int>(reason.without)];
    out["others"] = hidersJson(asked, reason.others);
    return out;
}

Json keptJson(const AskedScene& asked, const VisibleReason& reason) {
    Json out;
    out["because"] = keptBecauseName(reason.because);
    if (reason.because == KeptBecause::kStageOff) out["stage"] = kStageNames[static_cast<int>(reason.stage)];
    if (reason.because == KeptBecause::kBudgetSpent)
        out["budget"] = reason.second_look_spent ? "second-look-polygons" : "occluder-triangles";
    if (reason.because != KeptBecause::kOpenPixel) return out;
    out["asked"] = askedName(reason.by_faces, reason.by_triangles);
    out["pixel"] = {reason.x, reason.y};
    out["open_pixels"] = reason.open_pixels;
    out["pixels"] = reason.pixels;
    out["covered"] = reason.covered;
    if (reason.cover != ObjectId()) out["cover"] = objectJson(asked.scene, AskedScene::objectOf(reason.cover));
    return out;
}

/// What the witnesses say: of what was kept, as the end of a sentence about it; of what was culled, as a sentence.
std::string sightingText(const ObjectAnswer& answer) {
    const Sighting& sighting = *answer.sighting;
    if (answer.why.verdict != Verdict::kVisible)
        return sighting.seen
                   ? fmt::format("The {} sees it all the same at pixel ({:.1f}, {:.1f}): a false cull!",
                                 sighting.witness == "rays"    ? "witness of rays"
                                 : sighting.witness == "proof" ? "exact proof"
                                                               : "id-buffer",
                                 sighting.x, sighting.y)
                   : fmt::format("None of {} rays meets it, and no sample of an id-buffer{}.", grouped(sighting.rays),
                                 sighting.by_named
                                     ? ", and by exact arithmetic what it lies behind is enough to hide all of it"
                                 : sighting.proved_hidden ? ", and by exact arithmetic no point of it is visible"
                                                          : "");
    if (sighting.seen)
        return fmt::format("is seen: {} at pixel ({:.1f}, {:.1f}).",
                           sighting.witness == "rays"    ? "a ray meets it"
                           : sighting.witness == "proof" ? "by exact arithmetic nothing hides it"
                                                         : "the id-buffer has it",
                           sighting.x, sighting.y);
    std::string text = sighting.proved_hidden
                           ? "is hidden, which exact arithmetic proves"
                           : fmt::format("is seen by no witness, of {} rays and an id-buffer", grouped(sighting.rays));
    const VisibleReason& kept = answer.why.visible;
    if (kept.because == KeptBecause::kOpenPixel)
        text += kept.by_triangles ? ": it is kept because pixels of the occlusion buffer say less than rays"
                                  : ": it is kept because its box is larger than it is";
    return text + ".";
}

bool isByCells(const Explanation& why) {
    return why.verdict == Verdict::kNotInPvs || why.verdict == Verdict::kNoWindow;
}

/// Where the eye and what cells culled are, and the way between them.
std::string cellsText(const AskedScene& asked, const CellsReason& reason) {
    std::string text;
    if (!reason.eye.empty()) text += " The eye is in " + cellNames(asked, reason.eye, ", ") + ".";
    if (!reason.object.empty()) text += " It stands in " + cellNames(asked, reason.object, ", ") + ".";
    if (reason.way.size() > 1) text += " The way there: " + cellNames(asked, reason.way, ", then ") + ".";
    return text;
}

Json cellsJson(const AskedScene& asked, const CellsReason& reason) {
    const auto list = [&](const Array<uint32_t>& cells) {
        Json out = Json::array();
        for (const uint32_t cell : cells) {
            out.push_back({{"cell", cell}});
            if (cell < asked.cells.size()) out.back()["name"] = asked.cells[cell];
        }
        return out;
    };
    Json out;
    out["eye"] = list(reason.eye);
    if (reason.view_cells) out["view_cells"] = reason.view_cells;
    out["object"] = list(reason.object);
    out["reached"] = reason.reached;
    out["way"] = list(reason.way);
    out["portals"] = Json::array();
    for (const uint32_t portal : reason.portals) out["portals"].push_back(portal);
    if (reason.work_spent) out["work_spent"] = true;
    return out;
}

std::string eyeText(const ObjectAnswer& answer) {
    return answer.eye == 0 ? "" : answer.eye == kLeftEye ? "left eye:  " : "right eye: ";
}

// Without zeros below 0.
glm::dvec3 standingAt(const View& view) { return eyePosition(view) + 0.0; }
glm::dvec3 lookingAlong(const View& view) { return 0.0 - glm::dvec3(glm::row(view.view, 2)); }

}  // namespace

Result<std::vector<uint32_t>> findObjects(const Scene& scene, const std::string& word) {
    std::set<uint64_t> keys;
    std::vector<uint32_t> found;
    uint64_t key = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), key);
    if (fault == std::errc() && end == word.data() + word.size()) {
        found = withOneKey(
            scene, [&](const SceneObject& object) { return object.key == key; }, keys);
        if (!found.empty()) return found;
    }
    found = withOneKey(
        scene, [&](const SceneObject& object) { return objectPath(scene, object) == word; }, keys);
    if (!found.empty()) return found;
    if (!keys.empty()) return ambiguous(scene, word, keys);
    found = withOneKey(
        scene, [&](const SceneObject& object) { return object.name == word; }, keys);
    if (!found.empty()) return found;
    if (!keys.empty()) return ambiguous(scene, word, keys);
    const std::string part = lower(word);
    found = withOneKey(
        scene,
        [&](const SceneObject& object) { return lower(objectPath(scene, object)).find(part) != std::string::npos; },
        keys);
    if (keys.empty()) {
        std::vector<std::string> names;
        for (const SceneObject& object : scene.objects) names.push_back(object.name);
        return Error{Error::Kind::kUsage,
                     fmt::format("--object {}: {} has no object of that key, name or path{}; info --objects lists them",
                                 oneLine(word), scene.name, oneLine(suggestion(word, names)))};
    }
    if (found.empty()) return ambiguous(scene, word, keys);
    return found;
}

std::vector<Layer> layersAt(const Scene& scene, const View& view, uint32_t x, uint32_t y, size_t most) {
    const View pixel = throughPixel(view, x, y);
    const RenderList list(scene, pixel);
    std::vector<DrawItem> items(list.list().items().begin(), list.list().items().end());
    std::vector<Layer> layers;
    const bool parallel = isOrthographic(view);
    while (layers.size() < most && !items.empty()) {
        const ZBufferImage image = renderZBuffer(items, pixel);
        const uint32_t object = image.id.front();
        if (object == ZBufferImage::kNone) break;
        layers.push_back({object, parallel ? -image.depth.front() : 1.0 / image.depth.front()});
        std::erase_if(items, [&](const DrawItem& item) { return item.id == object; });
    }
    addClear(scene, pixel, layers);
    std::stable_sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.depth < b.depth; });
    if (layers.size() > most) layers.resize(most);
    return layers;
}

std::string titleOf(const Scene& scene, uint32_t object) {
    const std::string path = oneLine(objectPath(scene, scene.objects[object]), kLongestCall);
    const std::string key = fmt::format("object {}", scene.objects[object].key);
    return path.empty() ? key : fmt::format("{} '{}'", key, path);
}

std::string callOf(const Scene& scene, uint32_t object) {
    const std::string path = oneLine(objectPath(scene, scene.objects[object]), kLongestCall);
    return path.empty() ? fmt::format("object {}", scene.objects[object].key) : fmt::format("'{}'", path);
}

std::string cellNames(const AskedScene& asked, std::span<const uint32_t> cells, const char* between) {
    constexpr size_t kMost = 8;
    std::string text;
    for (size_t i = 0; i < std::min(cells.size(), kMost); ++i) {
        const bool named = cells[i] < asked.cells.size() && !asked.cells[cells[i]].empty();
        text += i ? between : "";
        text += named ? "'" + oneLine(asked.cells[cells[i]], 60) + "'" : fmt::format("cell {}", cells[i]);
    }
    if (cells.size() > kMost) text += fmt::format("{}{} more", between, cells.size() - kMost);
    return text;
}

AskedScene::AskedScene(const Scene& from, const RunOptions& options) : scene(from) {
    LoadSettings settings = loadSettingsOf(options);
    settings.volumes = true;
    Progress progress("preparing", "meshes", scene.meshes.size());
    loaded = loadWorld(
        scene, [&](size_t done, size_t total) { progress.set(done, total); }, settings);
    attachVisibility(options, loaded.world);
    if (options.opened) cells = options.opened->file.cellSpace().names;
    now = loaded.world.commit();
}

AskedScene::AskedScene(const Scene& from, LoadedWorld world) : scene(from), loaded(std::move(world)) {
    now = loaded.world.commit();
}

std::vector<EyeView> eyesOfFrame(const CameraFrame& camera, const RunOptions& options) {
    const View first = viewOf(camera, options);
    if (!(options.stereo > 0)) return {{first, 0}};
    return {{first, kLeftEye}, {shiftedEye(first, options.stereo), kRightEye}};
}

std::vector<uint32_t> namedHiders(const Explanation& why) {
    std::vector<uint32_t> objects;
    if (why.verdict != Verdict::kOccluded || !why.occlusion.sufficient || why.occlusion.outside_too) return objects;
    for (const Hider& hider : why.occlusion.hiders) objects.push_back(AskedScene::objectOf(hider.id));
    return objects;
}

Sighting lookFor(const Scene& scene, const View& view, uint32_t object, std::vector<uint32_t> named,
                 const RunOptions& options) {
    // Witnesses tell where they saw what was culled: so this object, and no other, is called culled.
    std::vector<uint8_t> culled(scene.objects.size(), 0);
    culled[object] = 1;
    WitnessSettings settings;
    settings.rays = options.rays;
    settings.aimed_rays = std::min(settings.aimed_rays, options.rays / 5);
    const FrameVerdict verdict = Witness(scene).judge(view, culled, settings);
    Sighting sighting;
    sighting.rays = verdict.rays;
    for (const FalseCull& seen : verdict.false_culls) {
        if (seen.object != object) continue;
        sighting.seen = true;
        sighting.x = seen.x;
        sighting.y = seen.y;
        sighting.witness = seen.witness;
    }
    if (sighting.seen || options.no_proofs) return sighting;
    const SceneFacts facts(scene);
    CullProver prover(facts, view);
    const CullProof proof = prover.prove(object);
    if (proof.result == ProofResult::kSeen) {
        sighting.seen = true;
        sighting.x = proof.x;
        sighting.y = proof.y;
        sighting.witness = "proof";
    }
    sighting.proved_hidden = proof.result == ProofResult::kProved;
    sighting.hiders = proof.hiders;
    if (!sighting.proved_hidden || named.empty()) return sighting;
    named.push_back(object);  // of its own triangles some hide others
    std::sort(named.begin(), named.end());
    sighting.by_named = prover.proveBy(object, named).result == ProofResult::kProved;
    return sighting;
}

std::string frameLine(const Scene& scene, const ExplainOptions& options, size_t frames, const View& view) {
    const glm::dvec3 eye = standingAt(view), along = lookingAlong(view);
    return wrapped(fmt::format("{} of {}: the eye at ({}, {}, {}), looking along ({}, {}, {})",
                               frameOf(options.first_frame, frames), ownerOfPath(scene, options), readable(eye.x, 5),
                               readable(eye.y, 5), readable(eye.z, 5), readable(along.x, 2), readable(along.y, 2),
                               readable(along.z, 2)),
                   kColumns, "  ") +
           "\n";
}

Json cameraJson(const Scene& scene, const ExplainOptions& options, const View& view) {
    const glm::dvec3 eye = standingAt(view), along = lookingAlong(view);
    return {{"frame", options.first_frame},
            {"of", ownerOfPath(scene, options)},
            {"eye", {eye.x, eye.y, eye.z}},
            {"along", {along.x, along.y, along.z}}};
}

std::string answerSentences(const AskedScene& asked, const ObjectAnswer& answer) {
    const auto name = [&](ObjectId id) { return asked.nameOf(id); };
    const std::string sighting = answer.sighting ? sightingText(answer) : std::string();
    const bool kept = answer.why.verdict == Verdict::kVisible;
    std::string text;
    if (answer.kept)
        text = answer.why.unasked
                   ? "kept without a question, because it was visible a few answers before; asked, it is "
                   : "kept for want of a certificate; to a query that remembers nothing it is ";
    text += explanationText(answer.why, titleOf(asked.scene, answer.object), name, kept ? sighting : std::string());
    if (!kept && !sighting.empty()) text += " " + sighting;
    if (isByCells(answer.why)) text += cellsText(asked, answer.why.cells);
    return text;
}

std::string answerText(const AskedScene& asked, const ObjectAnswer& answer) {
    return wrapped(eyeText(answer) + answerSentences(asked, answer), kColumns, "  ") + "\n";
}

std::string answerLine(const AskedScene& asked, const ObjectAnswer& answer) {
    // Where there is no room, one occluder is named; and of a long path its end, which tells most.
    constexpr std::pair<size_t, size_t> kRooms[] = {{6, kColumns}, {1, kColumns}, {1, 48}};
    const std::string stage = stageOf(answer.why);
    std::string line;
    for (const auto& [occluders, width] : kRooms) {
        if (!line.empty() && line.size() <= kColumns) break;
        const auto name = [&, most = width](ObjectId id) {
            std::string call = asked.nameOf(id);
            return call.size() > most && call.front() == '\'' ? "'" + oneLine(call.substr(1), most - 1) : call;
        };
        line = fmt::format("frame {:>4}  {}{:<10} {}{}", answer.frame, eyeText(answer),
                           stage.empty() || answer.kept ? "kept" : stage,
                           !answer.kept         ? ""
                           : answer.why.unasked ? "unasked; by itself: "
                                                : "no certificate; by itself: ",
                           explanationClause(answer.why, name, occluders));
    }
    return shortened(line, kColumns) + "\n";
}

Json answerJson(const AskedScene& asked, const ObjectAnswer& answer) {
    const Explanation& why = answer.why;
    Json out;
    out["frame"] = answer.frame;
    if (answer.eye) out["eye"] = answer.eye == kLeftEye ? "left" : "right";
    out.update(objectJson(asked.scene, answer.object));
    out["verdict"] = verdictName(why.verdict);
    out["stage"] = stageOf(why).empty() ? Json(nullptr) : Json(stageOf(why));
    out["together"] = why.together;
    if (why.cut) out["cut"] = true;
    out["rectangle"] = nullptr;
    if (why.on_screen) {
        out["rectangle"] = {why.rect.left, why.rect.top, why.rect.right, why.rect.bottom};
        out["depth"] = why.depth;
    }
    if (why.verdict == Verdict::kOutsideFrustum || why.occlusion.outside_too) out["frustum"] = frustumJson(why.frustum);
    if (why.verdict == Verdict::kOccluded) out["occlusion"] = occlusionJson(asked, why.occlusion);
    if (why.verdict == Verdict::kTooFar)
        out["distance"] = {{"distance", why.size.distance}, {"limit", why.size.distance_limit}};
    if (why.verdict == Verdict::kTooSmall)
        out["contribution"] = {{"radius", why.size.radius}, {"limit", why.size.radius_limit}};
    if (isByCells(why)) out["cells"] = cellsJson(asked, why.cells);
    if (why.clusters.clusters > 0)
        out["clusters"] = {{"clusters", why.clusters.clusters},   {"back", why.clusters.back},
                           {"outside", why.clusters.outside},     {"hidden", why.clusters.hidden},
                           {"triangles", why.clusters.triangles}, {"drawn", why.clusters.drawn}};
    if (why.verdict == Verdict::kVisible) out["kept"] = keptJson(asked, why.visible);
    if (answer.kept) out["kept_all_the_same"] = true;
    if (why.unasked) out["unasked"] = true;
    if (!why.certificate.empty()) {
        out["certificate"] = Json::array();
        for (const Visible& hider : why.certificate)
            out["certificate"].push_back(objectJson(asked.scene, AskedScene::objectOf(hider.id)));
    }
    if (!answer.shadows.empty()) out["shadows"] = shadowsJson(asked, answer.shadows);
    if (answer.sighting) {
        const Sighting& sighting = *answer.sighting;
        out["witness"] = {{"seen", sighting.seen}, {"rays", sighting.rays}};
        if (sighting.seen) {
            out["witness"]["pixel"] = {sighting.x, sighting.y};
            out["witness"]["by"] = sighting.witness;
        }
        if (sighting.proved_hidden) {
            out["witness"]["proved_hidden"] = true;
            out["witness"]["hiders"] = Json::array();
            for (const uint32_t hider : sighting.hiders)
                out["witness"]["hiders"].push_back(objectJson(asked.scene, hider));
        }
        if (sighting.by_named) out["witness"]["by_named"] = true;
    }
    out["text"] = answerSentences(asked, answer);
    return out;
}

}  // namespace sightline::cli
