// A scene as a world, and what its camera sees of it: asked anew when something has changed.
// SPDX-License-Identifier: MIT
#include "apps/viewer/culler.h"

#include <algorithm>
#include <cstring>

#include <fmt/core.h>

#include "sightline/cells/portal_graph.h"
#include "sightline/query/explain/credits.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/explain/shadows.h"
#include "sightline/tools/report/run/explain_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/world/world_state.h"

namespace sightline::viewer {
using namespace tools;
namespace {

constexpr size_t kMostNamed = 200'000;  // objects of which names are compared

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
    if (scene.objects.size() <= kMostNamed)
        for (const SceneObject& object : scene.objects) ++names_[{object.name, object.node}];
    if (hasCells()) listDoors();
    listClusters();
}

void Culler::listClusters() {
    cluster_orders_.resize(scene_.meshes.size());
    for (uint32_t object = 0; object < scene_.objects.size(); ++object) {
        const ClustersId clusters = now_.state().object(object).clusters;
        if (clusters.index == 0) continue;
        cluster_orders_[scene_.objects[object].mesh] = now_.state().clusters[clusters.index]->triangles;
        has_clusters_ = true;
    }
}

/// The bake names a door after the object that shuts it; of several of one name, with the object's key behind it.
void Culler::listDoors() {
    const detail::AttachedCells& cells = *now_.state().cell_state.cells;
    std::map<std::string, uint32_t> object_of;
    for (uint32_t object = 0; object < scene_.objects.size(); ++object) {
        const SceneObject& of = scene_.objects[object];
        object_of.try_emplace(of.name, object);
        object_of.try_emplace(fmt::format("{} {}", of.name, of.key), object);
    }
    for (const auto& name : cells.doors) {
        ViewerDoor& door = doors_.emplace_back();
        door.name = door.label = std::string(name.begin(), name.end());
        const auto known = object_of.find(door.name);
        if (known == object_of.end()) continue;
        door.object = known->second;
        door.label = objectPath(scene_, scene_.objects[known->second]);
    }
    set_.assign(doors_.size(), 1.0f);
    const PortalCorners corners = cells.graph.corners();
    std::vector<uint8_t> known(cells.graph.portals(), 0);
    for (uint32_t cell = 0; cell < cells.graph.cells(); ++cell)
        for (const DirectedPortal& portal : cells.graph.portalsFrom(cell)) {
            if (portal.door == CellPortal::kNone || known[portal.portal]++) continue;
            ViewerDoor& door = doors_[portal.door];
            std::vector<glm::dvec3>& outline = door.portals.emplace_back();
            for (uint32_t i = portal.first; i < portal.first + portal.count; ++i)
                outline.emplace_back(corners.x[i], corners.y[i], corners.z[i]);
            if (!outline.empty()) door.middle = outline.front();
        }
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
    has_casters_ = has_hides_ = false;
    for (const Visible& object : set.objects) visible_.push_back(objectOf(object.id));
    levels_.assign(set.lods.empty() ? 0 : scene_.objects.size(), 0);
    for (size_t i = 0; i < set.lods.size(); ++i) levels_[visible_[i]] = set.lods[i].level;
    takeRanges(set);
    std::sort(visible_.begin(), visible_.end());
    fresh_ = true;
    has_reasons_ = false;
    return true;
}

/// Before `visible_` is sorted.
void Culler::takeRanges(const VisibleSet& set) {
    ranges_.assign(set.ranges.begin(), set.ranges.end());
    for (DrawRange& range : ranges_) range.object = visible_[range.object];
    std::stable_sort(ranges_.begin(), ranges_.end(),
                     [](const DrawRange& a, const DrawRange& b) { return a.object < b.object; });
}

std::span<const DrawRange> Culler::rangesOf(uint32_t object) const {
    const auto before = [](const DrawRange& range, uint32_t of) { return range.object < of; };
    const auto first = std::lower_bound(ranges_.begin(), ranges_.end(), object, before);
    const auto end = std::lower_bound(first, ranges_.end(), object + 1, before);
    return {first, end};
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

std::span<const HidesMost> Culler::hidesMost() {
    if (has_hides_) return hides_;
    hides_.clear();
    for (const Credit& credit : CreditBook(now_).credits(view_, settings))
        if (credit.hidden > 0) hides_.push_back({objectOf(credit.id), credit.hidden});
    std::stable_sort(hides_.begin(), hides_.end(),
                     [](const HidesMost& a, const HidesMost& b) { return a.hidden > b.hidden; });
    has_hides_ = true;
    return hides_;
}

std::string Culler::nameOf(uint32_t object) const {
    const SceneObject& of = scene_.objects[object];
    const std::string path = objectPath(scene_, of);
    if (path.empty()) return fmt::format("object {}", of.key);
    const auto named = names_.find({of.name, of.node});
    const bool alone = named == names_.end() || named->second == 1;
    return alone ? fmt::format("'{}'", oneLine(path, 60)) : fmt::format("'{}' #{}", oneLine(path, 60), of.key);
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
