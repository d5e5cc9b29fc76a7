// Clips occluder polygons at the near plane, remembering which mesh edges its sides lie on.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/near_clip.h"

#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

struct Corner {
    double x, y, w, d, near;
};

Corner project(const Screen& object, double x, double y, double z) {
    const auto row = [&](const glm::dvec4& r) { return r.x * x + r.y * y + r.z * z + r.w; };
    return {row(object.x), row(object.y), row(object.w), row(object.d), row(object.near)};
}

Corner cornerAt(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, uint8_t vertex) {
    SIGHTLINE_DEBUG_ASSERT(vertex < cluster.vertex_count);
    const size_t at = size_t{cluster.first_vertex} + vertex;
    SIGHTLINE_DEBUG_ASSERT(at < occluder.x.size());
    return project(object, occluder.x[at], occluder.y[at], occluder.z[at]);
}

/// Where the edge from an inside corner to an outside one meets the guard plane.
Corner cut(const Corner& in, const Corner& out, double guard) {
    const double t = (in.near - guard) / (in.near - out.near);
    const auto mix = [t](double a, double b) { return a + t * (b - a); };
    return {mix(in.x, out.x), mix(in.y, out.y), mix(in.w, out.w), mix(in.d, out.d), guard};
}

void emit(ClippedPolygon& out, const Corner& corner, uint8_t from, uint8_t to, bool open) {
    SIGHTLINE_DEBUG_ASSERT(out.count < ClippedPolygon::kMaxCorners);
    const int i = out.count++;
    out.x[i] = corner.w > 0.0 ? corner.x / corner.w : std::numeric_limits<double>::quiet_NaN();
    out.y[i] = corner.y / corner.w;
    out.d[i] = corner.d / corner.w;
    out.from[i] = from;
    out.to[i] = to;
    out.open[i] = open;
}

}  // namespace

bool clipAtNear(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, const uint8_t* vertices,
                int count, ClippedPolygon& out) {
    SIGHTLINE_DEBUG_ASSERT(count == 3 || count == 4);
    Corner corner[4];
    bool inside[4];
    int crossings = 0;
    for (int i = 0; i < count; ++i) {
        corner[i] = cornerAt(object, occluder, cluster, vertices[i]);
        inside[i] = corner[i].near >= object.near_guard;
        if (i > 0) crossings += inside[i] != inside[i - 1];
    }
    out.count = 0;
    if (crossings + (inside[0] != inside[count - 1]) > 2) return false;  // a quadrangle that is not convex
    for (int i = 0; i < count; ++i) {
        const int j = (i + 1) % count;
        if (inside[i]) emit(out, corner[i], vertices[i], vertices[j], false);
        if (inside[i] && !inside[j])  // the near plane's own edge starts here
            emit(out, cut(corner[i], corner[j], object.near_guard), 0, 0, true);
        if (!inside[i] && inside[j])
            emit(out, cut(corner[j], corner[i], object.near_guard), vertices[i], vertices[j], false);
    }
    if (out.count < 3) return false;
    for (int i = 0; i < out.count; ++i)
        if (!std::isfinite(out.x[i]) || !std::isfinite(out.y[i]) || !std::isfinite(out.d[i])) return false;
    return true;
}

}  // namespace sightline
