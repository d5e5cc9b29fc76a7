// The occlusion buffer by itself; then the whole query while a city grows, beside flat frustum culling.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/exact_boxes.h"
#include "bench/flat_boxes.h"
#include "bench/occlusion_core.h"
#include "bench/occlusion_proof.h"
#include "bench/query_threads.h"
#include "bench/small_polygons.h"
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

/// Objects kept, beside what the same box test keeps on an exact z-buffer and what a 4x4 id-buffer shows.
void measureTightness(const Scene& scene, const CameraPath& path, const Options& options, const std::string& where,
                      Table& table) {
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    const ExactBoxes exact(scene);
    Query query;
    std::vector<uint8_t> reasons(scene.objects.size());
    double kept = 0, exactly_kept = 0, seen = 0;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, kWidth, kHeight);
        kept += static_cast<double>(query.visible(now, view, settingsOf(options)).objects.size());
        query.reasons(reasons);
        const ExactBoxes::Answer answer = exact.test(view, settingsOf(options).occlusion_size, 4);
        for (size_t i = 0; i < reasons.size(); ++i) {
            exactly_kept += answer.kept[i] && reasons[i] != 1 + static_cast<int>(Stage::kFrustum);
            seen += answer.seen[i];
        }
    }
    const double n = static_cast<double>(path.frames.size());
    table.rows.push_back({where, "objects kept", kept / n, "objects", "same boxes, exact z-buffer", exactly_kept / n});
    table.rows.push_back(
        {where, "objects kept (over-estimate)", kept / n, "objects", "seen by a 4x4 id-buffer", seen / n});
}

}  // namespace

Table benchOcclusion(const Options& options) {
    Table table{"occlusion", {}};
    if (options.proof.wanted) {
        addProofs(options, table);
        return table;
    }
    const int repeat = options.repeat ? options.repeat : 15;
    if (options.scene) {
        const CameraPath path = seededCameras(*options.scene, 16, kSeed);
        const PathCost cost = measurePath(*options.scene, path, options, repeat);
        const std::string& where = options.scene->name;
        table.rows.push_back({where, "whole query", cost.query, "us", "flat frustum, SIMD", cost.flat});
        table.rows.push_back({where, "triangles submitted", cost.query_triangles, "triangles", "after flat frustum",
                              cost.flat_triangles});
        measureQueryThreads(*options.scene, path, where, repeat, table);
        measureTightness(*options.scene, path, options, where, table);
        return table;
    }
    if (options.only.empty()) measureSmallPolygons(options, table);
    measureOcclusionCore(options, table);
    if (!options.only.empty()) return table;
    const CameraPath path = cityStreetPath(kSeed, 16);
    double smallest = 0;
    for (uint32_t objects : {1000u, 10000u, 100000u, 1000000u}) {
        const Scene scene = makeCity(kSeed, objects);
        const PathCost cost = measurePath(scene, path, options, repeat);
        if (objects == 1000) smallest = cost.query;
        const std::string where = fmt::format("city:{}:{}", kSeed, objects);
        table.rows.push_back({where, "whole query", cost.query, "us", "flat frustum, SIMD", cost.flat});
        table.rows.push_back({where, "whole query", cost.query, "us", "city of 1000 objects", smallest});
        table.rows.push_back({where, "triangles submitted", cost.query_triangles, "triangles", "after flat frustum",
                              cost.flat_triangles});
        if (objects != 10000) continue;
        measureQueryThreads(scene, path, where, repeat, table);
        measureTightness(scene, path, options, where, table);
    }
    return table;
}

}  // namespace sightline::bench
