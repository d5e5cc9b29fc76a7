// Classifying many small polygons at once, by itself, on the clusters of a soup of triangles.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#define HWY_COMPILE_ALL_ATTAINABLE
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/small_polygons.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/small_classify-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

void classifyInner(const SmallPolygonsTask& task, SmallPolygons& out) { classifySmallPolygons<false>(task, out); }
void classifyBoth(const SmallPolygonsTask& task, SmallPolygons& out) { classifySmallPolygons<true>(task, out); }
void snapForBench(const double* x, const double* y, const double* nearness, uint32_t count, SnappedVertex* out) {
    snapVertices(x, y, nearness, count, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "bench/occlusion_scenes.h"
#include "bench/stopwatch.h"
#include "sightline/buffer/screen.h"
#include "sightline/prepare/occluder/occluder.h"

namespace sightline {

HWY_EXPORT(classifyInner);
HWY_EXPORT(classifyBoth);
HWY_EXPORT(snapForBench);

namespace bench {
namespace {

/// A cluster with its vertices on the screen.
struct Projected {
    SnappedVertex vertices[OccluderCluster::kMaxVertices];
    std::vector<double> x, y, d;
    SmallPolygonsTask task;
};

void project(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, Projected& out) {
    const size_t count = (cluster.vertex_count + 7u) / 8 * 8;
    for (std::vector<double>* v : {&out.x, &out.y, &out.d}) v->assign(count, 0.0);
    for (size_t i = 0; i < cluster.vertex_count; ++i) {
        const size_t v = cluster.first_vertex + i;
        const glm::dvec4 p(occluder.x[v], occluder.y[v], occluder.z[v], 1.0);
        const double w = glm::dot(object.w, p);
        const bool drawn = glm::dot(object.near, p) >= object.near_guard && w > 0;
        out.x[i] = drawn ? glm::dot(object.x, p) / w : std::numeric_limits<double>::quiet_NaN();
        out.y[i] = glm::dot(object.y, p) / w;
        out.d[i] = glm::dot(object.d, p) / w;
    }
    HWY_DYNAMIC_DISPATCH(snapForBench)
    (out.x.data(), out.y.data(), out.d.data(), static_cast<uint32_t>(count), out.vertices);
}

void measureSoup(SoupSize size, int repeat, Table& table) {
    const OcclusionScene scene = makeOcclusionSoup(size);
    const Screen screen = objectScreen(makeScreen(occlusionView(scene, 0, 1280, 720), 8192), glm::dmat4(1.0));
    std::vector<Occluder> occluders;
    occluders.reserve(scene.batches.size());
    std::vector<std::unique_ptr<Projected>> clusters;
    double polygons = 0;
    for (const OccluderBatch& batch : scene.batches) {
        const Occluder& occluder = occluders.emplace_back(prepareOccluder(batch.mesh()));
        for (const OccluderCluster& cluster : occluder.clusters) {
            Projected& out = *clusters.emplace_back(std::make_unique<Projected>());
            project(screen, occluder, cluster, out);
            out.task.polygons = occluder.polygons.data() + cluster.first_polygon;
            out.task.count = cluster.polygon_count;
            out.task.vertices = out.vertices;
            out.task.columns = out.task.stride = screen.width / 8;
            out.task.rows = screen.height / 8;
            out.task.reverse = screen.mirrored;
            out.task.slack = 0x1p-20f;
            polygons += cluster.polygon_count;
        }
    }
    auto out = std::make_unique<SmallPolygons>();
    std::vector<double> inner, both, snap;
    double records = 0, large = 0;
    const auto time = [&](std::vector<double>& times, auto work) {
        const double start = threadTime();
        for (const auto& cluster : clusters) work(*cluster);
        times.push_back((threadTime() - start) * 1e3 / polygons);
    };
    // As in a frame, the vertices are in the cache from being projected: they are snapped again each time.
    const auto again = [](Projected& c) {
        HWY_DYNAMIC_DISPATCH(snapForBench)
        (c.x.data(), c.y.data(), c.d.data(), static_cast<uint32_t>(c.x.size()), c.vertices);
    };
    for (int round = 0; round < repeat; ++round) {
        records = large = 0;
        time(snap, again);
        time(inner, [&](Projected& c) {
            again(c);
            HWY_DYNAMIC_DISPATCH(classifyInner)(c.task, *out);
            records += out->count;
            large += out->large_count;
        });
        time(both, [&](Projected& c) {
            again(c);
            HWY_DYNAMIC_DISPATCH(classifyBoth)(c.task, *out);
        });
        inner.back() -= snap.back();
        both.back() -= snap.back();
    }
    const std::string where = scene.name + " 1280x720";
    const Rows row{table, where};
    row("small polygons, ns each", medianOf(inner), "ns", "with outer masks", medianOf(both));
    row("small polygons, snapping", medianOf(snap), "ns", "classifying", medianOf(inner));
    row("small polygons, tiles each", records / (polygons - large), "tiles", "left to be drawn one by one, %",
        100 * large / polygons);
}

}  // namespace

void measureSmallPolygons(const Options& options, Table& table) {
    for (SoupSize size : {SoupSize::kArea, SoupSize::kSide})
        measureSoup(size, options.repeat ? options.repeat : 24, table);
}

}  // namespace bench
}  // namespace sightline
#endif  // HWY_ONCE
