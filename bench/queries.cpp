// Occlusion queries: what stop-and-wait, CHC and CHC++ ask, and what a frame takes, by a simulated GPU and by Mesa's GL.
// SPDX-License-Identifier: MIT
//
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008.
#include <span>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/query_walks.h"
#include "bench/stopwatch.h"
#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/studies/gpu/simulated_gpu.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr double kNode = 1e-7;  // the CPU's time for a node that is taken up  [seconds]

Asked simulate(const QueryScene& scene, const OcclusionQuerySettings& settings, uint32_t frames_late) {
    SimulatedGpuSettings late;
    late.frames_late = frames_late;
    SimulatedGpu gpu(scene.items, late);
    OcclusionQueries queries;
    Asked asked;
    for (const View& view : scene.views) {
        gpu.beginFrame(view);
        queries.draw(scene.tree.now(), view, gpu, settings);
        gpu.work(kNode * queries.stats().visited);
        gpu.endFrame();
        asked.add(queries.stats(), double(scene.views.size()));
    }
    asked.milliseconds = 1e3 * gpu.seconds() / double(scene.views.size());
    return asked;
}

void measureSimulated(const QueryScene& scene, std::span<const uint32_t> latencies, uint32_t leaf_items, Table& table) {
    for (const uint32_t late : latencies) {
        Asked by_method[kQueryMethods];
        for (int method = 0; method < kQueryMethods; ++method)
            by_method[method] = simulate(scene, queriesBy(static_cast<QueryMethod>(method), leaf_items), late);
        tellAsked(scene, fmt::format("answers {} frames late", late), "ms, simulated", by_method, table);
    }
}

/// Front to back against the tree's order and back to front.
void measureOrders(const QueryScene& scene, uint32_t leaf_items, Table& table) {
    OcclusionQuerySettings settings = queriesBy(QueryMethod::kChcPlusPlus, leaf_items);
    const Asked nearest = simulate(scene, settings, 0);
    settings.order = QueryOrder::kTree;
    const Asked tree = simulate(scene, settings, 0);
    settings.order = QueryOrder::kFarthest;
    const Asked farthest = simulate(scene, settings, 0);
    table.rows.push_back({scene.name, "chc++ in the tree's order", tree.milliseconds, "ms, simulated", "front to back",
                          nearest.milliseconds, tree.note()});
    table.rows.push_back({scene.name, "chc++ back to front", farthest.milliseconds, "ms, simulated", "front to back",
                          nearest.milliseconds, farthest.note()});
}

/// Notes what a device answers, and when.
struct Answers {
    std::vector<uint8_t> there;
    std::vector<uint64_t> samples;
};

class NotingDevice : public QueryDevice {
public:
    NotingDevice(QueryDevice& device, Answers& answers) : device_(device), answers_(answers) {}

    void draw(std::span<const uint32_t> items) override { device_.draw(items); }
    void ask(uint32_t question, std::span<const Box3d> boxes) override { device_.ask(question, boxes); }
    bool hasAnswer(uint32_t question) override {
        answers_.there.push_back(device_.hasAnswer(question));
        return answers_.there.back() != 0;
    }
    uint64_t answer(uint32_t question) override {
        answers_.samples.push_back(device_.answer(question));
        return answers_.samples.back();
    }

private:
    QueryDevice& device_;
    Answers& answers_;
};

/// Answers the same again, and does nothing else.
class AnsweringDevice : public QueryDevice {
public:
    explicit AnsweringDevice(const Answers& answers) : answers_(answers) {}

    void draw(std::span<const uint32_t>) override {}
    void ask(uint32_t, std::span<const Box3d>) override {}
    bool hasAnswer(uint32_t) override { return answers_.there[there_++] != 0; }
    uint64_t answer(uint32_t) override { return answers_.samples[samples_++]; }

private:
    const Answers& answers_;
    size_t there_ = 0, samples_ = 0;
};

/// What the walk over the tree takes by itself, where drawing and asking take nothing.
void measureWalkItself(const QueryScene& scene, Table& table) {
    const OcclusionQuerySettings settings = queriesBy(QueryMethod::kChcPlusPlus);
    Answers answers;
    SimulatedGpu gpu(scene.items);
    NotingDevice noting(gpu, answers);
    OcclusionQueries noted;
    double visited = 0;
    for (const View& view : scene.views) {
        gpu.beginFrame(view);
        noted.draw(scene.tree.now(), view, noting, settings);
        gpu.endFrame();
        visited += noted.stats().visited;
    }
    const auto again = [&] {
        AnsweringDevice device(answers);
        OcclusionQueries queries;
        for (const View& view : scene.views) queries.draw(scene.tree.now(), view, device, settings);
    };
    const double microseconds = threadTimes({again}, 9)[0];
    const double frames = double(scene.views.size());
    table.rows.push_back({scene.name, "chc++ by itself, a node taken up", 1e3 * microseconds / visited, "ns",
                          "as simulated", 1e9 * kNode,
                          fmt::format("{:.1f} us a frame of {:.0f} nodes", microseconds / frames, visited / frames)});
}

void measureAll(const Scene& scene, int repeat, Table& table) {
    constexpr uint32_t kLatencies[] = {0, 1, 3};
    const Walked small(scene, 120, 320, 180);
    for (const uint32_t leaf_items : {1u, 8u}) {
        if (leaf_items > 1)
            table.rows.push_back({small.scene().name, "leaves from here on", double(leaf_items), "items", "", 0});
        measureSimulated(small.scene(), kLatencies, leaf_items, table);
    }
    measureOrders(small.scene(), 1, table);
    measureWalkItself(small.scene(), table);
#ifdef SIGHTLINE_GL
    const Walked large(scene, 60, 1280, 720);
    measureQueriesOnGl(large.scene(), repeat, table);
    measureSideBySide(scene, small.scene(), table);
#else
    static_cast<void>(repeat);
#endif
}

}  // namespace

Table benchQueries(const Options& options) {
    Table table{"queries", {}};
    const int repeat = options.repeat ? options.repeat : 5;
    if (options.scene) {
        measureAll(*options.scene, repeat, table);
        return table;
    }
    constexpr uint32_t kLatencies[] = {0, 1, 2, 3};
    for (const int depth : {1, 2, 4, 8, 16}) {
        const Layers layers(depth);
        measureSimulated(layers.scene(), kLatencies, 1, table);
    }
    measureAll(makeCity(1, 3000), repeat, table);
    return table;
}

}  // namespace sightline::bench
