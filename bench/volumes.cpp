// Occluder volumes: what a few large convex occluders hide by themselves, and whether they pay before the tiles.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint64_t kSeed = 1;
constexpr uint32_t kFrames = 16;
constexpr uint32_t kStandard = 8;  // volumes, as View has it

/// What one choice of stages gives on a path: means over the frames, of medians over the repeats. Times are the thread's own.
struct Answer {
    double time = 0;  ///< [microseconds]
    double by_volumes = 0, by_tiles = 0, kept = 0;
};

struct Choice {
    uint32_t stages = 0, volumes = kStandard;
};

std::vector<Answer> measure(const Snapshot& now, const CameraPath& path, const std::vector<Choice>& choices,
                            int repeat) {
    std::vector<Answer> answers(choices.size());
    Query query;
    for (const CameraFrame& frame : path.frames) {
        std::vector<QueryStats> stats(choices.size());
        std::vector<std::function<void()>> jobs;
        for (size_t i = 0; i < choices.size(); ++i)
            jobs.push_back([&, i] {
                const View view = makeView(frame, 1280, 720);
                QuerySettings settings;
                settings.stages = choices[i].stages;
                settings.occluder_volumes = choices[i].volumes;
                stats[i] = query.visible(now, view, settings).stats;
            });
        const std::vector<double> times = threadTimes(jobs, repeat);
        for (size_t i = 0; i < choices.size(); ++i) {
            answers[i].time += times[i];
            answers[i].by_volumes += static_cast<double>(stats[i].stages[static_cast<int>(Stage::kVolumes)].culled);
            answers[i].by_tiles += static_cast<double>(stats[i].stages[static_cast<int>(Stage::kOcclusion)].culled);
            answers[i].kept += static_cast<double>(stats[i].visible);
        }
    }
    const double n = static_cast<double>(std::max<size_t>(path.frames.size(), 1));
    for (Answer& a : answers)
        for (double* value : {&a.time, &a.by_volumes, &a.by_tiles, &a.kept}) *value /= n;
    return answers;
}

/// The stage alone and before the tiles, and then with more and fewer volumes.
void measureScene(const Scene& scene, const CameraPath& path, const std::string& where, int repeat, Table& table) {
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(true, 0));
    const Snapshot now = loaded.world.commit();
    const uint32_t frustum = stageBit(Stage::kFrustum), volumes = stageBit(Stage::kVolumes),
                   tiles = stageBit(Stage::kOcclusion);
    std::vector<Choice> choices = {{frustum}, {frustum | volumes}, {frustum | tiles}, {frustum | volumes | tiles}};
    constexpr uint32_t kCounts[] = {1, 2, 4, 16, 32, 64};
    for (const uint32_t count : kCounts) {
        choices.push_back({frustum | volumes, count});
        choices.push_back({frustum | volumes | tiles, count});
    }
    const std::vector<Answer> a = measure(now, path, choices, repeat);
    const Answer &plain = a[0], &alone = a[1], &without = a[2], &both = a[3];
    const auto row = [&](const std::string& what, double value, const char* unit, const char* baseline, double base) {
        table.rows.push_back({where, what, value, unit, baseline, base});
    };
    row("volumes alone, culled", alone.by_volumes, "objects", "culled by the tiles alone", without.by_tiles);
    row("volumes alone, kept", alone.kept, "objects", "kept by frustum alone", plain.kept);
    row("volumes alone, query", alone.time, "us", "tiles alone, query", without.time);
    row("volumes alone, query", alone.time, "us", "frustum alone, query", plain.time);
    row("volumes and tiles, kept", both.kept, "objects", "kept by the tiles alone", without.kept);
    row("volumes and tiles, query", both.time, "us", "tiles alone, query", without.time);
    for (size_t i = 0; i < std::size(kCounts); ++i) {
        const Answer &some = a[4 + 2 * i], &before = a[5 + 2 * i];
        const std::string with = fmt::format("{} volume{}", kCounts[i], kCounts[i] == 1 ? "" : "s");
        row(with + " alone, culled", some.by_volumes, "objects", "culled by the tiles alone", without.by_tiles);
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
    for (uint32_t i = 0; i < kFrames; ++i) {
        const double angle = 6.283185307179586 * i / kFrames;
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
        measureScene(*options.scene, seededCameras(*options.scene, kFrames, kSeed), options.scene->name, repeat, table);
        return table;
    }
    const Scene city = makeCity(kSeed, 10000);
    measureScene(city, cityStreetPath(kSeed, kFrames), "city:1:10000, street", repeat, table);
    measureScene(city, pathAbove(city), "city:1:10000, above", repeat, table);
    const Scene building = makeBuilding(kSeed, 4);
    measureScene(building, seededCameras(building, kFrames, kSeed), "building:1:4", repeat, table);
    const Scene terrain = makeTerrain(kSeed, 512);
    measureScene(terrain, seededCameras(terrain, kFrames, kSeed), "terrain:1:512", repeat, table);
    return table;
}

}  // namespace sightline::bench
