// Draws clusters of plane groups: open edges, winding numbers in bit planes, depth from planes.
// SPDX-License-Identifier: MIT
#include "bench/onepass/draw.h"

#include <cmath>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/onepass/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bench/onepass/cluster-inl.h"
#include "bench/onepass/look-inl.h"
#include "bench/onepass/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

bool drawClusterKernel(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t index,
                       DrawScratch& scratch) {
    SIGHTLINE_DEBUG_ASSERT(index < mesh.clusters.size());
    const PlaneMesh::Cluster& c = mesh.clusters[index];
    ClusterView view = viewOf(frame, frame.near_w * (1 + 1e-6), c);
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {};
    if (faceGroups(mesh, c, glm::vec3(view.eye), view.away, turn, nullptr) == 0 ||
        !project(frame, mesh, c, view, scratch.image))
        return true;
    const Edges found = findEdges(image, frame, mesh, c, view, turn, scratch);
    if (found != Edges::kSome) return found != Edges::kUnknown;
    const int count = groupDepths<false>(image, frame, mesh, c, view.eye, turn, view.by_floats, scratch);
    const auto draw = [&](int column, int row, const BlockEdges& edges, const RowWinding<2>& before) HWY_ATTR {
        alignas(64) uint32_t covered[kBlockHeight];
        if (coverBlock(edges, before, kBlockWidth * column, covered))
            updateBlock(image, image.at(column, row), column, row, covered, scratch.groups, count);
        return false;
    };
    walkRows<2, true>(image, scratch, view.nearest, draw);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace sightline::bench {

HWY_EXPORT(clustersInViewKernel);
HWY_EXPORT(drawClusterKernel);
HWY_EXPORT(imageOfKernel);
HWY_EXPORT(isOpenKernel);
HWY_EXPORT(lookKernel);

AskedBox askedBox(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& w, const glm::dvec3& centre,
                  const glm::dvec3& half) {
    AskedBox out;
    const glm::dvec4 at(centre, 1);
    const auto take = [&](const glm::dvec4& row, float(&to)[4]) {
        for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(row[axis]);
        to[3] = static_cast<float>(glm::dot(row, at));
    };
    take(x, out.x);
    take(y, out.y);
    take(w, out.w);
    for (int axis = 0; axis < 3; ++axis) out.half[axis] = static_cast<float>(half[axis] * (1 + 1e-6));
    return out;
}

bool imageOf(const AskedBox& box, double near_w, BoxImage& out) {
    return HWY_DYNAMIC_DISPATCH(imageOfKernel)(box, static_cast<float>(near_w * (1 + 1e-6)), out);
}

bool drawCluster(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster,
                 DrawScratch& scratch) {
    return frame.usable && HWY_DYNAMIC_DISPATCH(drawClusterKernel)(image, frame, mesh, cluster, scratch);
}

uint32_t clustersInView(const DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t* out) {
    return HWY_DYNAMIC_DISPATCH(clustersInViewKernel)(static_cast<float>(image.width), static_cast<float>(image.height),
                                                      frame, mesh, out);
}

bool isClusterOpen(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster,
                   const AskedBox& box, DrawScratch& scratch) {
    return !frame.usable || HWY_DYNAMIC_DISPATCH(lookKernel)(image, frame, mesh, cluster, box, scratch);
}

bool isOpen(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box) {
    return HWY_DYNAMIC_DISPATCH(isOpenKernel)(image, x0, y0, x1, y1, nearness, box);
}

}  // namespace sightline::bench

#endif  // HWY_ONCE
