// Clips convex polygons in homogeneous clip space, for hidden-surface methods and the reference alone.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/clip.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline::studies {
namespace {

glm::dvec4 crossing(const glm::dvec4& inside, double inside_distance, const glm::dvec4& outside,
                    double outside_distance) {
    const double t = inside_distance / (inside_distance - outside_distance);
    return inside + t * (outside - inside);
}

}  // namespace

int clipToPlane(std::span<const glm::dvec4> in, const glm::dvec4& plane, std::span<glm::dvec4> out) {
    SIGHTLINE_ASSERT(out.size() > in.size());
    if (in.size() < 3) return 0;
    const size_t room = out.size();
    size_t count = 0;
    const glm::dvec4* previous = &in.back();
    double previous_distance = glm::dot(plane, *previous);
    double size = 0;
    for (const glm::dvec4& current : in) {
        const double distance = glm::dot(plane, current);
        size += std::abs(distance);
        if (previous_distance > 0 && distance < 0 && count < room)
            out[count++] = crossing(*previous, previous_distance, current, distance);
        if (previous_distance < 0 && distance > 0 && count < room)
            out[count++] = crossing(current, distance, *previous, previous_distance);
        if (distance >= 0 && count < room) out[count++] = current;
        previous = &current;
        previous_distance = distance;
    }
    return count < 3 || !std::isfinite(size) ? 0 : static_cast<int>(count);
}

void clipToPlane(const ClipPolygon& in, const glm::dvec4& plane, ClipPolygon& out) {
    // The last vertex has room unless all planes but this one have added theirs.
    static_assert(ClipPolygon::kMaxVertices == 3 + ClipPolygon::kMaxPlanes);
    glm::dvec4 kept[ClipPolygon::kMaxVertices + 1];
    const int count = clipToPlane({in.vertices, static_cast<size_t>(in.count)}, plane, kept);
    out.count = std::min(count, ClipPolygon::kMaxVertices);
    std::copy(kept, kept + out.count, out.vertices);
}

}  // namespace sightline::studies
