// Ray casting: a ray through each sample, the nearest triangle that it meets.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/raycast.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "sightline/hidden/fill.h"
#include "sightline/hidden/raycast_tree.h"
#ifdef SIGHTLINE_HIDDEN_EMBREE
#include "sightline/hidden/raycast_embree.h"
#endif

namespace sightline {
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

template <class Nearest>
void castAll(const SampleRays& rays, const Reach& reach, HiddenImage& image, Nearest&& nearest) {
    const int32_t width = static_cast<int32_t>(image.width), height = static_cast<int32_t>(image.height);
    for (int32_t row = 0; row < height; ++row)
        for (int32_t i = 0; i < width; ++i) {
            SampleRay ray = rays.at(row, i);
            ray.t_near = std::max(ray.t_near, reach.first);
            ray.t_far = std::min(ray.t_far, reach.last);
            ++image.counters.rays;
            const RayHit hit = nearest(ray);
            if (hit.surface != RayHit::kNone) fillSpan(image, row, i, i + 1, hit.surface);
        }
}

uint64_t nanosecondsSince(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

}  // namespace

bool hasEmbree() {
#ifdef SIGHTLINE_HIDDEN_EMBREE
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
#ifdef SIGHTLINE_HIDDEN_EMBREE
    if (input.settings.ray_tracer == RayTracer::kEmbree) {
        const EmbreeTree tree(triangles);
        image.counters.prepare_nanoseconds = nanosecondsSince(start);
        castAll(rays, reach, image, [&](const SampleRay& ray) { return tree.nearest(rays, ray); });
        return;
    }
#endif
    const RayTree tree(triangles);
    image.counters.prepare_nanoseconds = nanosecondsSince(start);
    std::vector<RayVisit> stack;
    castAll(rays, reach, image, [&](const SampleRay& ray) { return tree.nearest(rays, ray, stack); });
}

}  // namespace sightline
