// Which form of an occluder a view draws: the mesh's own polygons, or simpler ones inside of its solids.
// SPDX-License-Identifier: MIT
#include "sightline/stages/occluder_form.h"

#include <algorithm>

#include "sightline/base/assert.h"
#include "sightline/cull/occlusion.h"

namespace sightline::detail {

const Occluder& formFor(const HeldOccluder& occluder, const Screen& screen, const glm::dmat4& transform,
                        double most_error) {
    if (occluder.inner.empty() || !(most_error > 0)) return occluder;
    Screen object = objectScreen(screen, transform);
    object.near.w -= 2.0 * object.near_guard;
    const BoxAnswer box = projectBox(object, occluder.inner.front().outside);
    if (box.doubt || box.outside) return occluder;
    SIGHTLINE_DEBUG_ASSERT(!screen.perspective || box.rect.nearness > 0);
    // How far a step of one unit goes on the screen at most, about.
    const double stretch = glm::length(transform[0]) + glm::length(transform[1]) + glm::length(transform[2]);
    const glm::dvec3 across = glm::dvec3(screen.x) - 0.5 * screen.width * glm::dvec3(screen.w);
    const double w = screen.perspective ? 1.0 / static_cast<double>(box.rect.nearness) : screen.w.w;
    const double pixels = glm::length(across) * stretch / (1.75 * w);
    const Occluder* form = &occluder;
    for (const InnerOccluder& inner : occluder.inner)
        if (inner.error * pixels <= most_error) form = &inner.occluder;
    return *form;
}

bool isWhole(const ViewLimits& limits, const HeldOccluder& occluder, const glm::dmat4& transform) {
    if (!sightline::isWhole(limits, occluder.bounds, transform)) return false;
    return std::all_of(occluder.inner.begin(), occluder.inner.end(), [&](const InnerOccluder& inner) {
        return sightline::isWhole(limits, inner.outside, transform);
    });
}

bool isWhole(const ViewLimits& limits, const Occluder& occluder, const OccluderCluster& cluster,
             const glm::dmat4& transform) {
    if (!sightline::isWhole(limits, cluster.bounds, transform)) return false;
    if (cluster.ring_count == 0) return true;
    SIGHTLINE_DEBUG_ASSERT(size_t{cluster.first_vertex} + cluster.vertex_count <= occluder.x.size());
    for (uint32_t i = cluster.first_vertex; i < cluster.first_vertex + cluster.vertex_count; ++i)
        if (!sightline::isWhole(limits, glm::vec3(occluder.x[i], occluder.y[i], occluder.z[i]), transform))
            return false;
    return true;
}

}  // namespace sightline::detail
