// Walks at sixty frames a second, asked in order: what coherence there is to be had is measured by them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint64_t kSeeds[] = {101, 102, 103};

/// What one way of asking costs, frame by frame.
struct Costs {
    std::vector<double> times;  ///< the thread's own  [microseconds]
    double kept = 0;            ///< objects, of all frames
    size_t undrawn = 0;         ///< frames in which nothing was drawn

    void add(const VisibleSet& seen, double start) {
        times.push_back(threadTime() - start);
        kept += static_cast<double>(seen.objects.size());
        undrawn += seen.stats.occluder_triangles == 0;
    }
    double mean() const { return meanOf(times); }
    double percentile(double share) const { return percentileOf(times, share); }
    double keptAFrame() const { return kept / static_cast<double>(times.size()); }
};

/// A query that learns from another one, which is asked for the same view after it, as on another thread.
struct Taught {
    Query query, teacher;
    Costs of_query, of_teacher;

    void ask(const Snapshot& now, const View& view) {
        const double start = threadTime();
        query.learn(teacher);
        of_query.add(query.visible(now, view), start);
        const double then = threadTime();
        of_teacher.add(teacher.visible(now, view), then);
    }
    void begin() { query = Query(), teacher = Query(); }
};

/// Each frame once and in order, each way by a query of its own; the ways take turns.
void measureWalks(const Scene& scene, Table& table) {
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(true, 0));
    const Snapshot now = loaded.world.commit();
    const QuerySettings ways[] = {{.stages = stageBit(Stage::kFrustum)},
                                  {.stateless = true},
                                  {.unasked_answers = 0, .proofs = false},
                                  {.proofs = false},
                                  {}};
    Costs costs[std::size(ways)];
    Taught taught;
    size_t still = 0;
    for (const uint64_t seed : kSeeds) {
        Query queries[std::size(ways)];
        taught.begin();
        const std::vector<CameraFrame> frames = walkThrough(scene, {.seed = seed}).frames;
        for (size_t i = 0; i < frames.size(); ++i) {
            const View view = makeView(frames[i], 1280, 720);
            still += i > 0 && frames[i].eye == frames[i - 1].eye;
            for (size_t way = 0; way < std::size(ways); ++way) {
                const double start = threadTime();
                costs[way].add(queries[way].visible(now, view, ways[way]), start);
            }
            taught.ask(now, view);
        }
    }
    const Costs &frustum = costs[0], &stateless = costs[1], &asking = costs[2], &drawing = costs[3], &query = costs[4];
    const Rows row{table, scene.name};
    row("stateless, mean of a frame", stateless.mean(), "us", "frustum alone", frustum.mean());
    row("drawing, mean of a frame", drawing.mean(), "us", "stateless", stateless.mean());
    row("query, mean of a frame", query.mean(), "us", "drawing", drawing.mean(),
        fmt::format("nothing drawn in {} of {} frames", query.undrawn, query.times.size()));
    row("asking each time, mean of a frame", asking.mean(), "us", "stateless", stateless.mean());
    row("query, 99 of 100 frames", query.percentile(0.99), "us", "stateless", stateless.percentile(0.99));
    row("stateless, kept", stateless.keptAFrame(), "objects", "frustum alone", frustum.keptAFrame(),
        fmt::format("{} frames, {} standing", query.times.size(), still));
    row("asking each time, kept", asking.keptAFrame(), "objects", "stateless", stateless.keptAFrame());
    row("drawing, kept", drawing.keptAFrame(), "objects", "stateless", stateless.keptAFrame());
    row("query, kept", query.keptAFrame(), "objects", "stateless", stateless.keptAFrame());
    row("taught, mean of a frame", taught.of_query.mean(), "us", "stateless", stateless.mean(),
        fmt::format("nothing drawn in {} of {} frames", taught.of_query.undrawn, taught.of_query.times.size()));
    row("taught, 99 of 100 frames", taught.of_query.percentile(0.99), "us", "stateless", stateless.percentile(0.99));
    row("taught, kept", taught.of_query.keptAFrame(), "objects", "stateless", stateless.keptAFrame());
    row("its teacher, mean of a frame", taught.of_teacher.mean(), "us", "stateless", stateless.mean());
}

}  // namespace

Table benchWalks(const Options& options) {
    Table table{"walks", {}};
    if (options.scene) {
        measureWalks(*options.scene, table);
        return table;
    }
    for (const Scene& scene : {makeCity(1, 20000), makeBuilding(1, 10), makeTerrain(1, 512)})
        measureWalks(scene, table);
    return table;
}

}  // namespace sightline::bench
