// Occluder volumes: what a few large convex occluders hide by themselves, and whether they pay before the tiles.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/path_costs.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint64_t kSceneSeed = 1;
constexpr uint32_t kSceneViews = 16;
/// The stage alone and before the tiles, and then with more and fewer volumes.
void measureScene(const Scene& scene, const CameraPath& path, const std::string& where, int repeat, Table& table) {
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(true, 0));
    const Snapshot now = loaded.world.commit();
    const uint32_t frustum = stageBit(Stage::kFrustum), volumes = stageBit(Stage::kVolumes),
                   tiles = stageBit(Stage::kOcclusion);
    std::vector<QuerySettings> choices;
    for (const uint32_t stages : {frustum, frustum | volumes, frustum | tiles, frustum | volumes | tiles})
        choices.push_back({.stages = stages});
    constexpr uint32_t kCounts[] = {1, 2, 4, 16, 32, 64};
    for (const uint32_t count : kCounts) {
        choices.push_back({.stages = frustum | volumes, .occluder_volumes = count});
        choices.push_back({.stages = frustum | volumes | tiles, .occluder_volumes = count});
    }
    const std::vector<SettingsCost> a = costsAlong(path, now, choices, repeat);
    const SettingsCost &plain = a[0], &alone = a[1], &without = a[2], &both = a[3];
    const Rows row{table, where};
    const double by_tiles = without.culled[static_cast<int>(Stage::kOcclusion)];
    row("volumes alone, culled", alone.culled[static_cast<int>(Stage::kVolumes)], "objects",
        "culled by the tiles alone", by_tiles);
    row("volumes alone, kept", alone.kept, "objects", "kept by frustum alone", plain.kept);
    row("volumes alone, query", alone.time, "us", "tiles alone, query", without.time);
    row("volumes alone, query", alone.time, "us", "frustum alone, query", plain.time);
    row("volumes and tiles, kept", both.kept, "objects", "kept by the tiles alone", without.kept);
    row("volumes and tiles, query", both.time, "us", "tiles alone, query", without.time);
    for (size_t i = 0; i < std::size(kCounts); ++i) {
        const SettingsCost &some = a[4 + 2 * i], &before = a[5 + 2 * i];
        const std::string with = fmt::format("{} volume{}", kCounts[i], kCounts[i] == 1 ? "" : "s");
        row(with + " alone, culled", some.culled[static_cast<int>(Stage::kVolumes)], "objects",
            "culled by the tiles alone", by_tiles);
        row(with + " alone, query", some.time, "us", "tiles alone, query", without.time);
        row(with + " and tiles, query", before.time, "us", "tiles alone, query", without.time);
    }
}

/// Down onto the roofs from a circle around the city.
CameraPath pathAbove(const Scene& scene) {
    Box3d all;
    for (const SceneObject& object : scene.objects)
        all.grow(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    const double radius = 0.25 * std::max(all.size().x, all.size().z);
    CameraPath path;
    for (uint32_t i = 0; i < kSceneViews; ++i) {
        const double angle = 6.283185307179586 * i / kSceneViews;
        CameraFrame frame;
        frame.eye = all.center() + glm::dvec3(radius * std::cos(angle), 0, radius * std::sin(angle));
        frame.eye.y = all.max.y + 0.1 * radius;
        frame.target = all.center();
        frame.target.y = all.min.y;
        path.frames.push_back(frame);
    }
    return path;
}

}  // namespace

Table benchVolumes(const Options& options) {
    Table table{"volumes", {}};
    const int repeat = options.repeat ? options.repeat : 9;
    if (options.scene) {
        measureScene(*options.scene, seededCameras(*options.scene, kSceneViews, kSceneSeed), options.scene->name,
                     repeat, table);
        return table;
    }
    const Scene city = makeCity(kSceneSeed, 10000);
    measureScene(city, cityStreetPath(kSceneSeed, kSceneViews), "city:1:10000, street", repeat, table);
    measureScene(city, pathAbove(city), "city:1:10000, above", repeat, table);
    const Scene building = makeBuilding(kSceneSeed, 4);
    measureScene(building, seededCameras(building, kSceneViews, kSceneSeed), "building:1:4", repeat, table);
    const Scene terrain = makeTerrain(kSceneSeed, 512);
    measureScene(terrain, seededCameras(terrain, kSceneViews, kSceneSeed), "terrain:1:512", repeat, table);
    return table;
}

}  // namespace sightline::bench
