// Ray casting: a ray through each sample, the nearest triangle that it meets.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/rays/raycast.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "sightline/studies/hidden/methods/fill.h"
#include "sightline/studies/hidden/rays/raycast_tree.h"
#include "sightline/studies/hidden/threads.h"
#ifdef SIGHTLINE_STUDIES_EMBREE
#include "sightline/studies/hidden/rays/raycast_embree.h"
#endif

namespace sightline::studies {
namespace {

using Clock = std::chrono::steady_clock;

/// Where a view's rays may meet anything at all: finite ends for those that have none.
struct Reach {
    double first = std::numeric_limits<double>::infinity(), last = -first;
};

Reach reachOf(const RayTriangles& triangles, const SampleRays& rays) {
    Reach reach;
    if (triangles.bounds.empty()) return reach;
    double size = 0;
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 point = triangles.origin - rays.eye();
        for (int axis = 0; axis < 3; ++axis)
            point[axis] += (corner >> axis & 1) != 0 ? triangles.bounds.max[axis] : triangles.bounds.min[axis];
        const double t = glm::dot(rays.depthAxis(), point);
        size = std::max(size, std::abs(t));
        reach.first = std::min(reach.first, t);
        reach.last = std::max(reach.last, t);
    }
    reach.first -= 1e-9 * size;
    reach.last += 1e-9 * size;
    return reach;
}

/// Casts the rays of one row.
/// @return how many met something
template <class Nearest>
uint64_t castRow(const SampleRays& rays, const Reach& reach, int32_t row, HiddenImage& image, Nearest& nearest) {
    uint64_t met = 0;
    for (int32_t i = 0; i < static_cast<int32_t>(image.width); ++i) {
        SampleRay ray = rays.at(row, i);
        ray.t_near = std::max(ray.t_near, reach.first);
        ray.t_far = std::min(ray.t_far, reach.last);
        const RayHit hit = nearest(ray);
        if (hit.surface == RayHit::kNone) continue;
        image.at(row, i) = hit.surface;
        for (std::vector<uint16_t>* counts : {&image.generated, &image.passed, &image.shaded})
            countSpan(image, *counts, row, i, i + 1);
        ++met;
    }
    return met;
}

/// Rows are taken in turn by up to `threads` threads: the image is the same for any number.
/// @param make_nearest  gives each thread its own function from a ray to what it meets
template <class MakeNearest>
void castAll(const SampleRays& rays, const Reach& reach, uint32_t threads, HiddenImage& image,
             MakeNearest&& make_nearest) {
    std::atomic<uint32_t> next_row{0};
    std::atomic<uint64_t> met{0};
    FirstFault fault;
    const auto work = [&](uint32_t) {
        fault.guard([&] {
            auto nearest = make_nearest();
            for (uint32_t row = next_row++; row < image.height; row = next_row++)
                met += castRow(rays, reach, static_cast<int32_t>(row), image, nearest);
        });
    };
    std::vector<std::thread> others = startThreads(std::min(threads, image.height), work);
    work(0);
    for (std::thread& other : others) other.join();
    fault.rethrow();
    image.counters.rays = uint64_t{image.width} * image.height;
    for (uint64_t* count : {&image.counters.generated, &image.counters.passed, &image.counters.shaded}) *count = met;
}

uint64_t nanosecondsSince(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

}  // namespace

bool hasEmbree() {
#ifdef SIGHTLINE_STUDIES_EMBREE
    return true;
#else
    return false;
#endif
}

void drawRaycast(const HiddenInput& input, HiddenImage& image) {
    const Clock::time_point start = Clock::now();
    const RayTriangles triangles = rayTriangles(input.list, input.settings.projector);
    const SampleRays rays(input.view);
    const Reach reach = reachOf(triangles, rays);
    const uint32_t threads = input.settings.threads;
#ifdef SIGHTLINE_STUDIES_EMBREE
    if (input.settings.ray_tracer == RayTracer::kEmbree) {
        const EmbreeTree tree(triangles);
        image.counters.prepare_nanoseconds = nanosecondsSince(start);
        castAll(rays, reach, threads, image,
                [&] { return [&](const SampleRay& ray) { return tree.nearest(rays, ray); }; });
        return;
    }
#endif
    const RayTree tree(triangles);
    image.counters.prepare_nanoseconds = nanosecondsSince(start);
    castAll(rays, reach, threads, image, [&] {
        return [&, stack = std::vector<RayVisit>()](const SampleRay& ray) mutable {
            return tree.nearest(rays, ray, stack);
        };
    });
}

}  // namespace sightline::studies
