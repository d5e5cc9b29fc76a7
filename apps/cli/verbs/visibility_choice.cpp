// The visibility file that a run asks for: opened, held to its scene, and attached to the world.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/visibility_choice.h"

#include "apps/cli/verbs/common.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/verbs/vis_map.h"
#include "sightline/bake/objects/scene_hash.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

/// How many of the file's objects stand in the scene where they stood when it was baked.
uint64_t countInPlace(const Scene& scene, const PlacedObjects& objects) {
    std::multimap<uint64_t, Box3d> boxes;
    for (const SceneObject& object : scene.objects)
        boxes.emplace(object.key, transformBox(scene.meshes[object.mesh].bounds, object.transform));
    uint64_t count = 0;
    for (size_t i = 0; i < objects.size(); ++i) {
        const auto [first, end] = boxes.equal_range(objects.key(i));
        const Box3d wanted = objects.bounds(i);
        count += std::any_of(
            first, end, [&](const auto& box) { return box.second.min == wanted.min && box.second.max == wanted.max; });
    }
    return count;
}

/// Whether a compiled map is among the files: its file is known by the hash of the map itself.
bool isOfMap(const SceneChoice& scene) {
    return std::any_of(scene.names.begin(), scene.names.end(), [](const std::string& name) {
        const std::string kind = mapKind(name);
        return !isProcedural(name) && (kind == ".bsp" || kind == ".pak" || kind == ".pk3");
    });
}

/// The first few, and how many there are.
std::string doorNames(const CellSpace& space) {
    constexpr size_t kMost = 6;
    if (space.doors.empty()) return "it has none";
    std::string text = fmt::format("it has {}: ", space.doors.size());
    for (size_t i = 0; i < std::min(space.doors.size(), kMost); ++i)
        text += (i ? ", \"" : "\"") + oneLine(space.doors[i].name, 60) + "\"";
    return text + (space.doors.size() > kMost ? ", ..." : "");
}

Error wrongFile(const std::string& file, const std::string& what) {
    return {Error::Kind::kInput, oneLine(file) + ": " + what};
}

/// Finds what the file holds of the meshes of the scene that it was baked of.
Status openPrepared(const Scene& scene, const std::string& name, OpenedVisibility& opened) {
    Result<PreparedMeshes> prepared = opened.file.prepared(name);
    if (!prepared) return prepared.error();
    opened.prepared = std::move(*prepared);
    opened.of_mesh.assign(scene.meshes.size(), nullptr);
    const PlacedObjects& objects = opened.file.objects();
    for (const SceneObject& object : scene.objects) {
        const auto [first, end] = objects.find(object.key);
        if (end - first != 1) continue;
        const uint32_t mesh = opened.prepared.mesh_of_object[first];
        if (mesh != PreparedMeshes::kNone) opened.of_mesh[object.mesh] = &opened.prepared.meshes[mesh];
    }
    return success();
}

}  // namespace

Status openVisibility(const Scene& scene, RunOptions& options) {
    const std::string& name = options.visibility.file;
    if (name.empty()) return success();
    Result<std::string> bytes = readTextFile(name);
    if (!bytes) return bytes.error();
    // The file looks into its bytes, which must not move any more.
    auto text = std::make_unique<std::string>(std::move(*bytes));
    Result<VisibilityFile> file = VisibilityFile::open(*text, name);
    if (!file) return file.error();
    if (!file->hasCells())
        return wrongFile(name, "it has rows of visibility, but no cells: `sightline bake` writes both");
    const CellSpace space = file->cellSpace();
    for (const DoorAsked& door : options.visibility.doors)
        if (std::none_of(space.doors.begin(), space.doors.end(),
                         [&](const CellDoor& other) { return other.name == door.name; }))
            return Error{Error::Kind::kUsage, fmt::format("--door: there is no door \"{}\" in {} ({})",
                                                          oneLine(door.name), oneLine(name), doorNames(space))};
    if (!isOfMap(options.scene) && file->mapHash() != hashOf(scene))
        return wrongFile(name, "it was baked of another scene: its hash is not this one's");
    World empty;
    if (Status fits = empty.attach(*file); !fits) return wrongFile(name, fits.error().message);
    if (file->hasObjects() && file->objects().size() > 0) {
        const uint64_t all = file->objects().size(), there = countInPlace(scene, file->objects());
        // What moved may have been a wall: nothing that the file says holds then.
        if (there < all)
            return wrongFile(name,
                             fmt::format("it was baked of another scene: {} of its {} objects are not where it says",
                                         grouped(all - there), grouped(all)));
    }
    const auto opened = std::make_shared<OpenedVisibility>(std::move(text), std::move(*file));
    if (opened->file.hasPrepared() && !isOfMap(options.scene))
        if (Status taken = openPrepared(scene, name, *opened); !taken) return taken;
    options.opened = opened;
    return success();
}

LoadSettings loadSettingsOf(const RunOptions& options) {
    LoadSettings load = loadSettings(options.settings, options.cluster_test);
    if (!options.opened) return load;
    const auto any = [&](auto has) {
        const Array<PreparedMesh>& meshes = options.opened->prepared.meshes;
        return std::any_of(meshes.begin(), meshes.end(), has);
    };
    if (load.inner && !any([](const PreparedMesh& mesh) { return !mesh.inner.empty(); })) return load;
    // Clusters are made for what a test costs.
    if (load.clusters && (options.cluster_test != FacingCost().test ||
                          !any([](const PreparedMesh& mesh) { return mesh.clusters.count() > 0; })))
        return load;
    load.prepared = options.opened->of_mesh;
    return load;
}

void attachVisibility(const RunOptions& options, World& world) {
    if (!options.opened) return;
    (void)world.attach(options.opened->file);
    for (const DoorAsked& door : options.visibility.doors) world.setPortal(world.findPortal(door.name), door.open);
}

}  // namespace sightline::cli
