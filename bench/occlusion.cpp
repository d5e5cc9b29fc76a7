// The occlusion buffer by itself; then the whole query while a city grows, beside flat frustum culling.
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/flat_boxes.h"
#include "bench/occlusion_proof.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint64_t kSeed = 1;
constexpr uint32_t kWidth = 1280, kHeight = 720;

/// Means over a path, of medians over the repeats.
struct PathCost {
    double query = 0, flat = 0;                      ///< [microseconds]
    double query_triangles = 0, flat_triangles = 0;  ///< submitted
    double visible = 0;
};

QuerySettings settingsOf(const Options& options) {
    QuerySettings settings;
    if (options.occlusion_size > 0) settings.occlusion_size = options.occlusion_size;
    return settings;
}

PathCost measurePath(const Scene& scene, const CameraPath& path, const Options& options, int repeat) {
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    FlatBoxes flat(objectBoxes(scene));
    Query query;
    PathCost sum;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, kWidth, kHeight);
        VisibleSet set;
        size_t kept = 0;
        const std::vector<double> times =
            timeInterleaved({[&] { set = query.visible(now, view, settingsOf(options)); },
                             [&] { kept = cullFrustum(makeFrustum(view), flat.arrays, flat.kept); }},
                            repeat);
        sum.query += times[0];
        sum.flat += times[1];
        sum.visible += static_cast<double>(set.objects.size());
        for (const Visible& v : set.objects)
            sum.query_triangles += static_cast<double>(scene.meshes[scene.objects[v.id.index - 1].mesh].triangles());
        for (size_t i = 0; i < kept; ++i)
            sum.flat_triangles += static_cast<double>(scene.meshes[scene.objects[flat.kept[i]].mesh].triangles());
    }
    const double n = static_cast<double>(path.frames.size());
    for (double* value : {&sum.query, &sum.flat, &sum.query_triangles, &sum.flat_triangles, &sum.visible}) *value /= n;
    return sum;
}

}  // namespace

Table benchOcclusion(const Options& options) {
    Table table{"occlusion", {}};
    if (options.proof.wanted) {
        addProofs(options, table);
        return table;
    }
    const int repeat = options.repeat ? options.repeat : 15;
    double smallest = 0;
    const auto measure = [&](const Scene& scene, const CameraPath& path, const std::string& where, bool closely) {
        const PathCost cost = measurePath(scene, path, options, repeat);
        if (smallest == 0) smallest = cost.query;
        const Rows row{table, where};
        row("whole query", cost.query, "us", "flat frustum, SIMD", cost.flat);
        if (!options.scene) row("whole query", cost.query, "us", "city of 1000 objects", smallest);
        row("triangles submitted", cost.query_triangles, "triangles", "after flat frustum", cost.flat_triangles);
        if (!closely) return;
        measureQueryThreads(scene, path, where, repeat, table);
        measureTightness(scene, path, settingsOf(options).occlusion_size, where, table);
    };
    if (options.scene) {
        measure(*options.scene, seededCameras(*options.scene, 16, kSeed), options.scene->name, true);
        return table;
    }
    measureOcclusionCore(options, table);
    if (!options.only.empty()) return table;
    for (uint32_t objects : {1000u, 10000u, 100000u, 1000000u})
        measure(makeCity(kSeed, objects), cityStreetPath(kSeed, 16), fmt::format("city:{}:{}", kSeed, objects),
                objects == 10000);
    return table;
}

}  // namespace sightline::bench
