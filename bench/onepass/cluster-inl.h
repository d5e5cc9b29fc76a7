// What a view makes of a cluster: its edges, and the depth of its groups.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_CLUSTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_CLUSTER_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_CLUSTER_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_CLUSTER_INL_H
#endif

#include <cmath>
#include <limits>

#include "bench/onepass/depth-inl.h"
#include "bench/onepass/project-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

/// What a view makes of a cluster.
struct ClusterView {
    glm::dvec3 eye;  ///< from the cluster's centre
    float away;      ///< the eye from the centre
    float w_error;   ///< what w may be off by
    float near_w;    ///< what is nearer is cut off
    bool by_floats;  ///< images of vertices are known well enough in floats
    float nearest;   ///< nothing of it is nearer, once edges are found  [nearness]
};

ClusterView viewOf(const ObjectFrame& frame, double near_w, const PlaneMesh::Cluster& c) {
    ClusterView out{};
    out.eye = frame.eye - glm::dvec3(c.centre);
    out.away = static_cast<float>(glm::length(out.eye));
    out.w_error = 0x1p-20f * frame.length_w * (out.away + c.radius);
    out.near_w = static_cast<float>(near_w);
    return out;
}

/// @returns whether some of it is beyond the near plane
bool project(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, ClusterView& view,
             ClusterImage& out) {
    projectVertices(frame, mesh, c, view.away + c.radius, view.w_error, out);
    view.by_floats = out.w_min > view.near_w + view.w_error && out.r_max < 0.25f;
    return out.w_max + view.w_error > view.near_w;
}

/// kOutside: it is not in the image, or not open there. kNone: no edges. kUnknown: there is no room for them.
enum class Edges { kOutside, kNone, kUnknown, kSome };

/// Gathers the edges on whose sides groups are drawn otherwise.
Edges findEdges(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c,
                ClusterView& view, const int8_t* turn, DrawScratch& scratch) {
    const ClusterImage& projected = scratch.image;
    EdgeList& edges = scratch.edges;
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    edges.count = 0;
    edges.full = false;
    if (view.by_floats) {
        const float x0 = projected.x0 - 1, y0 = projected.y0 - 1, x1 = projected.x1 + 1, y1 = projected.y1 + 1;
        view.nearest = (1 + 1e-5f) / (projected.w_min - view.w_error);
        if (!(x1 > 0 && y1 > 0 && x0 < width && y0 < height) ||
            !isRectOpen(image, x0, y0, x1, y1, view.nearest * (1 + 1e-6f)))
            return Edges::kOutside;
        gatherEdges(mesh, c, turn, projected, edges);
    } else {
        projectExactly(frame, mesh, c, scratch.exact);
        if (!cutEdges(frame, scratch.exact, view.near_w, mesh, c, turn, width, height, edges, scratch.rects,
                      view.nearest))
            return Edges::kUnknown;
    }
    if (edges.full) return Edges::kUnknown;
    for (int i = 0; frame.sign < 0 && i < edges.count; ++i) edges.change[i] = -edges.change[i];
    return edges.count == 0 ? Edges::kNone : Edges::kSome;
}

/// Where a group may be in the image.
GroupRect rectOf(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, uint32_t group, bool by_floats,
                 const DrawScratch& scratch) {
    if (!by_floats) return scratch.rects[group];
    GroupRect out;
    const size_t at = size_t{c.first_group} + group;
    for (uint32_t k = 0; k < mesh.corner_count[at]; ++k) {
        const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
        out.grow(scratch.image.x[v], scratch.image.y[v], scratch.image.r[v]);
    }
    return out;
}

/// The depth of the groups that are drawn, for the middles of tiles that they may meet.
/// @returns how many
template <bool kNearest>
int groupDepths(const DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c,
                const glm::dvec3& eye, const int8_t* turn, bool by_floats, DrawScratch& scratch) {
    GroupPlanes& planes = scratch.planes;
    planesOf<kNearest>(frame, mesh, c, eye, static_cast<float>(image.width), static_cast<float>(image.height), planes);
    int count = 0;
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        GroupDepth& of = scratch.groups[count++];
        of.plane = {planes.a[g], planes.b[g], planes.c[g]};
        // Seen nearly edge-on its nearness has no bound but the cluster's.
        if (kNearest && !(std::abs(of.plane.a) + std::abs(of.plane.b) + std::abs(of.plane.c) < 1e30f))
            of.plane = {0, 0, std::numeric_limits<float>::infinity()};
        const float lean = 4.0f * (std::abs(of.plane.a) + std::abs(of.plane.b));
        of.bound = kNearest ? of.plane.c + lean : of.plane.c - lean;
        of.index = DepthBlock::kNoPlane;
        of.rect = rectOf(mesh, c, g, by_floats, scratch).wider(5);
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
