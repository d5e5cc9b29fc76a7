// The refinement of a query's frustum stage, on scenes.
// SPDX-License-Identifier: MIT
#include "bench/query_refinement.h"

#include "bench/stopwatch.h"
#include "sightline/load/load_world.h"
#include "sightline/load/seeded_cameras.h"
#include "sightline/run/query.h"

namespace sightline::bench {

void addQueryRefinement(Table& table, const std::string& where, const Scene& scene, int repeat) {
    constexpr uint32_t kViews = 16;
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    const CameraPath path = seededCameras(scene, kViews, 1);
    const double far = 0.1 * glm::length(worldBounds(scene).size());
    Query query;
    for (const bool short_view : {false, true})
        for (const bool all_stages : {false, true}) {
            std::vector<View> views;
            for (CameraFrame camera : path.frames) {
                if (short_view) camera.z_far = far;
                views.push_back(makeView(camera, 1280, 720));
                if (!all_stages) views.back().stages = stageBit(Stage::kFrustum);
            }
            uint64_t kept[3] = {}, nodes[3] = {};
            const auto run = [&](Refinement refinement) {
                const size_t which = static_cast<size_t>(refinement);
                kept[which] = nodes[which] = 0;
                for (View& view : views) {
                    view.refinement = refinement;
                    const QueryStats stats = query.visible(now, view).stats;
                    kept[which] += stats.visible;
                    nodes[which] += stats.nodes_visited;
                }
            };
            const std::vector<double> times =
                threadTimes({[&] { run(Refinement::kNone); }, [&] { run(Refinement::kCorners); },
                             [&] { run(Refinement::kSeparatingAxes); }},
                            repeat ? repeat : 15);
            const std::string what =
                where + (short_view ? "; short view" : "") + (all_stages ? "; all stages" : "; frustum");
            const char* const names[] = {"", "corners", "separating axes"};
            for (size_t i = 1; i < 3; ++i) {
                const std::string name = std::string("query, ") + names[i];
                table.rows.push_back({what, name, times[i] / kViews, "us", "planes alone", times[0] / kViews});
                table.rows.push_back({what, name + ": kept", static_cast<double>(kept[i]) / kViews, "objects",
                                      "planes alone", static_cast<double>(kept[0]) / kViews});
                table.rows.push_back({what, name + ": visited", static_cast<double>(nodes[i]) / kViews, "nodes",
                                      "planes alone", static_cast<double>(nodes[0]) / kViews});
            }
        }
}

}  // namespace sightline::bench
