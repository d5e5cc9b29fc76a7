// A scene as a world, and what its camera sees of it: asked anew when something has changed.
// SPDX-License-Identifier: MIT
#include "apps/viewer/culler.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "sightline/query/explain/explain.h"
#include "sightline/query/explain/shadows.h"
#include "sightline/tools/report/run/explain_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/world/world_state.h"

namespace sightline::viewer {
using namespace tools;
namespace {

bool sameView(const View& a, const View& b) {
    return a.view == b.view && a.projection == b.projection && a.width == b.width && a.height == b.height &&
           a.jitter == b.jitter && a.sections.count == b.sections.count &&
           std::equal(a.sections.planes, a.sections.planes + a.sections.count, b.sections.planes);
}

}  // namespace

Culler::Culler(const Scene& scene, LoadedWorld world, const QuerySettings& asked)
    : settings(asked), scene_(scene), world_(std::move(world)), now_(world_.world.commit()) {
    for (uint32_t object = 0; object < world_.ids.size(); ++object) {
        object_of_.resize(std::max<size_t>(object_of_.size(), world_.ids[object].index + 1), 0);
        object_of_[world_.ids[object].index] = object;
        const SceneObject& of = scene.objects[object];
        bounds_.push_back(transformBox(scene.meshes[of.mesh].bounds, of.transform));
    }
    settings.time_stages = true;
    settings.lod_fade = 0;    // nobody asks again while nothing moves
    settings.proofs = false;  // until the user wants them: the buffer is shown, and a switch put back changes nothing
    if (!hasCells()) return;
    for (const auto& name : now_.state().cell_state.cells->doors) doors_.push_back({std::string(name), 1.0f});
    set_.assign(doors_.size(), 1.0f);
}

bool Culler::hasCells() const { return now_.state().cell_state.cells != nullptr; }

void Culler::moveDoors() {
    bool moved = false;
    for (size_t i = 0; i < doors_.size(); ++i) {
        if (doors_[i].open == set_[i]) continue;
        world_.world.setPortal(world_.world.findPortal(doors_[i].name), static_cast<double>(doors_[i].open));
        set_[i] = doors_[i].open;
        moved = true;
    }
    if (!moved) return;
    now_ = world_.world.commit();
    fresh_ = false;
}

bool Culler::ask(const View& view) {
    moveDoors();
    if (fresh_ && sameView(view, view_) && std::memcmp(&settings, &asked_, sizeof settings) == 0) return false;
    std::memcpy(&asked_, &settings, sizeof settings);
    view_ = view;
    const VisibleSet set = query_.visible(now_, view, settings);
    stats_ = set.stats;
    visible_.clear();
    receivers_.assign(set.objects.begin(), set.objects.end());
    has_casters_ = false;
    for (const Visible& object : set.objects) visible_.push_back(objectOf(object.id));
    levels_.assign(set.lods.empty() ? 0 : scene_.objects.size(), 0);
    for (size_t i = 0; i < set.lods.size(); ++i) levels_[visible_[i]] = set.lods[i].level;
    std::sort(visible_.begin(), visible_.end());
    fresh_ = true;
    has_reasons_ = false;
    return true;
}

std::span<const uint8_t> Culler::reasons() {
    if (!has_reasons_) {
        reasons_.resize(now_.objectCount());
        query_.reasons(reasons_);
        has_reasons_ = true;
    }
    return reasons_;
}

std::span<const uint32_t> Culler::casters(const glm::dvec3& sun) {
    if (has_casters_) return casters_;
    Light light;
    light.direction = -sun;
    const CasterSet set = shadow_query_.casters(now_, view_, receivers_, light);
    caster_stats_ = set.stats;
    casters_.clear();
    for (const Visible& object : set.casters) casters_.push_back(objectOf(object.id));
    std::sort(casters_.begin(), casters_.end());
    has_casters_ = true;
    return casters_;
}

std::string Culler::nameOf(uint32_t object) const {
    const std::string path = objectPath(scene_, scene_.objects[object]);
    return path.empty() ? fmt::format("object {}", scene_.objects[object].key) : fmt::format("'{}'", oneLine(path, 60));
}

ObjectWhy Culler::why(uint32_t object) const {
    const ObjectId id = world_.ids[object];
    const Explanation found = query_.explain(now_, view_, id, settings);
    ObjectWhy why;
    why.kept = found.verdict == Verdict::kVisible;
    why.text = explanationText(found, nameOf(object), [&](ObjectId of) { return nameOf(objectOf(of)); });
    for (const Hider& hider : found.occlusion.hiders) why.hiders.push_back(objectOf(hider.id));
    if (found.verdict != Verdict::kOccluded) return why;
    Array<HiderOutline> outlines;
    Array<glm::dvec3> corners;
    if (!query_.certificateOf(id, outlines, corners)) findShadows(now_, view_, id, settings, outlines, corners);
    for (const HiderOutline& outline : outlines) {
        const auto first = corners.begin() + outline.first;
        why.outlines.emplace_back(first, first + outline.count);
    }
    return why;
}

}  // namespace sightline::viewer
