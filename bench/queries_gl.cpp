// Occlusion queries and two-pass culling on Mesa's software GL: what a frame takes, and what each keeps beside the query.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "apps/gl/queries.h"
#include "apps/gl/two_pass.h"
#include "bench/query_walks.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/load/load_world.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

void measureMesa(const QueryScene& scene, int repeat, Table& table) {
    Result<GlContext> context = GlContext::create(1);
    if (!context) return;
    Result<GlQueryDevice> device = GlQueryDevice::create(*context, scene.items, GlQueryKind::kAny);
    if (!device) return;
    Asked by_method[kQueryMethods];
    std::vector<std::vector<double>> times(kQueryMethods);
    for (int round = 0; round < repeat; ++round)
        for (int method = 0; method < kQueryMethods; ++method) {
            OcclusionQuerySettings settings = queriesBy(static_cast<QueryMethod>(method));
            settings.rounding.depth_step = 0;
            OcclusionQueries queries;
            by_method[method] = {};
            const auto start = std::chrono::steady_clock::now();
            for (const View& view : scene.views) {
                if (!device->beginFrame(view)) return;
                queries.draw(scene.tree.now(), view, *device, settings);
                if (!device->endFrame()) return;
                by_method[method].add(queries.stats(), double(scene.views.size()));
            }
            times[static_cast<size_t>(method)].push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() /
                double(scene.views.size()));
        }
    for (int method = 0; method < kQueryMethods; ++method)
        by_method[method].milliseconds = medianOf(times[static_cast<size_t>(method)]);
    tellAsked(scene, "Mesa in software", "ms", by_method, table);
}

/// Two passes on the same GL beside one that draws all.
void measureTwoPass(const QueryScene& scene, int repeat, Table& table) {
    Result<GlContext> context = GlContext::create(1);
    if (!context) return;
    const std::vector<GlCullPart> parts = makeCullParts(scene.items);
    Result<GlTwoPass> culled = GlTwoPass::create(*context, scene.items, parts),
                      all = GlTwoPass::create(*context, scene.items, parts);
    if (!culled || !all) return;
    double drawn = 0;
    const auto milliseconds = [&](auto&& frame) {
        const auto start = std::chrono::steady_clock::now();
        for (const View& view : scene.views) frame(view);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() /
               double(scene.views.size());
    };
    std::vector<double> times[2];
    for (int round = 0; round < repeat; ++round) {
        times[0].push_back(milliseconds([&](const View& view) { static_cast<void>(culled->draw(view)); }));
        times[1].push_back(milliseconds([&](const View& view) { static_cast<void>(all->drawAll(view)); }));
    }
    for (const View& view : scene.views) {
        if (!culled->draw(view)) return;
        const Result<GlTwoPass::Drawn> passes = culled->readDrawn();
        if (!passes) return;
        for (size_t i = 0; i < parts.size(); ++i) drawn += (passes->early[i] | passes->late[i]) != 0;
    }
    table.rows.push_back({scene.name, "two passes, Mesa in software", medianOf(times[0]), "ms", "all, without culling",
                          medianOf(times[1]),
                          fmt::format("{:.0f} items drawn of {}", drawn / double(scene.views.size()), parts.size())});
}

/// What one way of culling keeps of what is seen.
struct Kept {
    double kept = 0, missed = 0;

    void add(const std::vector<uint8_t>& drawn, const std::vector<uint8_t>& seen) {
        for (size_t i = 0; i < drawn.size(); ++i) {
            kept += drawn[i];
            missed += seen[i] != 0 && drawn[i] == 0;
        }
    }
};

}  // namespace

void measureQueriesOnGl(const QueryScene& scene, int repeat, Table& table) {
    measureMesa(scene, repeat, table);
    measureTwoPass(scene, repeat, table);
}

void measureSideBySide(const Scene& scene, const QueryScene& walked, Table& table) {
    Result<GlContext> context = GlContext::create(1);
    if (!context) return;
    Result<GlQueryDevice> device = GlQueryDevice::create(*context, walked.items, GlQueryKind::kAny);
    const std::vector<GlCullPart> parts = makeCullParts(walked.items);
    Result<GlTwoPass> passes = GlTwoPass::create(*context, walked.items, parts);
    if (!device || !passes) return;
    LoadedWorld loaded = loadWorld(scene);
    const Snapshot now = loaded.world.commit();
    std::vector<uint32_t> object_of;  // by the id's index
    for (uint32_t object = 0; object < loaded.ids.size(); ++object) {
        object_of.resize(std::max<size_t>(object_of.size(), loaded.ids[object].index + 1), 0);
        object_of[loaded.ids[object].index] = object;
    }
    Query query;
    OcclusionQueries queries;
    OcclusionQuerySettings settings;
    settings.rounding.depth_step = 0;
    ZBufferSettings fine;
    fine.samples = 4;
    fine.want_generated = false;
    Kept by_query, by_chc, by_passes;
    double seen_count = 0;
    for (const View& view : walked.views) {
        std::vector<uint8_t> seen = renderZBuffer(walked.items, view, fine).seen;
        seen.resize(scene.objects.size(), 0);
        for (const uint8_t one : seen) seen_count += one;
        std::vector<uint8_t> drawn(scene.objects.size(), 0);
        for (const Visible& visible : query.visible(now, view).objects) drawn[object_of[visible.id.index]] = 1;
        by_query.add(drawn, seen);
        drawn.assign(scene.objects.size(), 0);
        if (!device->beginFrame(view)) return;
        for (const uint32_t item : queries.draw(walked.tree.now(), view, *device, settings))
            drawn[walked.items[item].id] = 1;
        if (!device->endFrame()) return;
        by_chc.add(drawn, seen);
        drawn.assign(scene.objects.size(), 0);
        if (!passes->draw(view)) return;
        const Result<GlTwoPass::Drawn> done = passes->readDrawn();
        if (!done) return;
        for (size_t i = 0; i < parts.size(); ++i)
            if ((done->early[i] | done->late[i]) != 0) drawn[walked.items[parts[i].item].id] = 1;
        by_passes.add(drawn, seen);
    }
    const double frames = double(walked.views.size());
    const auto tellKept = [&](const char* how, const Kept& kept) {
        table.rows.push_back({walked.name, fmt::format("kept by {}", how), kept.kept / frames, "objects",
                              "seen by 16 samples a pixel", seen_count / frames,
                              fmt::format("{:.3f} of these missed in a frame", kept.missed / frames)});
    };
    tellKept("the query", by_query);
    tellKept("chc++ on Mesa", by_chc);
    tellKept("two passes on Mesa", by_passes);
}

}  // namespace sightline::bench
