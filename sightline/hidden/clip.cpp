// Clips convex polygons in homogeneous clip space, for the reference renderer alone.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/clip.h"

namespace sightline {
namespace {

glm::dvec4 crossing(const glm::dvec4& inside, double inside_distance, const glm::dvec4& outside,
                    double outside_distance) {
    const double t = inside_distance / (inside_distance - outside_distance);
    return inside + t * (outside - inside);
}

}  // namespace

void clipToPlane(const ClipPolygon& in, const glm::dvec4& plane, ClipPolygon& out) {
    out.count = 0;
    if (in.count < 3) return;
    glm::dvec4 previous = in.vertices[in.count - 1];
    double previous_distance = glm::dot(plane, previous);
    for (int i = 0; i < in.count; ++i) {
        const glm::dvec4 current = in.vertices[i];
        const double distance = glm::dot(plane, current);
        // A convex polygon crosses a plane twice; rounding may bend one that lies in the plane, and then
        // a vertex more than fits is one that changes nothing.
        const bool room = out.count < ClipPolygon::kMaxVertices;
        if (previous_distance >= 0 && distance < 0 && room)
            out.vertices[out.count++] = crossing(previous, previous_distance, current, distance);
        if (previous_distance < 0 && distance >= 0 && room)
            out.vertices[out.count++] = crossing(current, distance, previous, previous_distance);
        if (distance >= 0 && out.count < ClipPolygon::kMaxVertices) out.vertices[out.count++] = current;
        previous = current;
        previous_distance = distance;
    }
    if (out.count < 3) out.count = 0;
}

}  // namespace sightline
