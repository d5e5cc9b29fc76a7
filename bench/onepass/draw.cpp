// Draws clusters of plane groups: open edges, winding numbers in bit planes, depth from planes; asks rectangles.
// SPDX-License-Identifier: MIT
#include "bench/onepass/draw.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/onepass/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bench/onepass/ask-inl.h"
#include "bench/onepass/cover-inl.h"
#include "bench/onepass/depth-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

/// Row over vertices relative to the cluster's centre: m holds it, in floats, and its value at the centre.
struct Row {
    float x, y, z, at_centre;
};

Row rowOf(const glm::dvec4& row, const glm::dvec3& centre) {
    return {static_cast<float>(row.x), static_cast<float>(row.y), static_cast<float>(row.z),
            static_cast<float>(glm::dot(glm::dvec3(row), centre) + row.w)};
}

HWY_INLINE VF apply(const Row& row, VF x, VF y, VF z) {
    const F f;
    return hn::Add(hn::Add(hn::Mul(hn::Set(f, row.x), x), hn::Mul(hn::Set(f, row.y), y)),
                   hn::Add(hn::Mul(hn::Set(f, row.z), z), hn::Set(f, row.at_centre)));
}

/// Which groups surely show their front (1) or, drawn from both sides, their back (-1) to the eye; 0: all others. A group
/// that is not 0 has no polygon that faces otherwise, so that no winding number is less than 0.
/// @returns how many are not 0
int faceGroups(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const glm::vec3& eye, float away, int8_t* turn) {
    const F f;
    int count = 0;
    const float reach = away + c.radius;
    for (uint32_t g = 0; g < c.groups; g += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_group} + g;
        const VF h = hn::Sub(hn::Add(hn::Add(hn::Mul(hn::LoadU(f, &mesh.nx[at]), hn::Set(f, eye.x)),
                                             hn::Mul(hn::LoadU(f, &mesh.ny[at]), hn::Set(f, eye.y))),
                                     hn::Mul(hn::LoadU(f, &mesh.nz[at]), hn::Set(f, eye.z))),
                             hn::LoadU(f, &mesh.nd[at]));
        // What floats may be off by, what vertices lie off the plane, and what a triangle may lean.
        const VF room =
            hn::Add(hn::LoadU(f, &mesh.thick[at]),
                    hn::Mul(hn::Add(hn::LoadU(f, &mesh.tilt[at]), hn::Set(f, 0x1p-20f)), hn::Set(f, reach)));
        const auto front = hn::Gt(h, room);
        const VF back = hn::IfThenElseZero(hn::Lt(h, hn::Neg(room)), hn::LoadU(f, &mesh.both[at]));
        const VF turns = hn::IfThenElse(front, hn::Set(f, 1.0f), hn::Neg(back));
        hn::StoreU(hn::DemoteTo(hn::Rebind<int8_t, F>(), hn::ConvertTo(I(), turns)), hn::Rebind<int8_t, F>(), turn + g);
        count += static_cast<int>(hn::CountTrue(f, hn::Ne(turns, hn::Zero(f))));
    }
    return count;
}

void projectVertices(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, ClusterImage& out) {
    const F f;
    const glm::dvec3 centre(c.centre);
    const Row rx = rowOf(frame.x, centre), ry = rowOf(frame.y, centre), rw = rowOf(frame.w, centre);
    VF x0 = hn::Set(f, 3e38f), y0 = x0, w0 = x0, x1 = hn::Set(f, -3e38f), y1 = x1, w1 = x1;
    for (uint32_t i = 0; i < c.vertices; i += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_vertex} + i;
        const VF x = hn::LoadU(f, &mesh.x[at]), y = hn::LoadU(f, &mesh.y[at]), z = hn::LoadU(f, &mesh.z[at]);
        const VF w = apply(rw, x, y, z);
        const VF px = hn::Div(apply(rx, x, y, z), w), py = hn::Div(apply(ry, x, y, z), w);
        hn::Store(px, f, out.x + i);
        hn::Store(py, f, out.y + i);
        x0 = hn::Min(x0, px);
        x1 = hn::Max(x1, px);
        y0 = hn::Min(y0, py);
        y1 = hn::Max(y1, py);
        w0 = hn::Min(w0, w);
        w1 = hn::Max(w1, w);
    }
    const auto least = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(f, v)); };
    const auto most = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(f, v)); };
    out.x0 = least(x0);
    out.y0 = least(y0);
    out.w_min = least(w0);
    out.x1 = most(x1);
    out.y1 = most(y1);
    out.w_max = most(w1);
}

/// Draws what the edges bound.
void rasterize(DepthBlocks& image, DrawScratch& scratch, float r, float nearest, int count) {
    RowEdge* const row_edges = scratch.row_edges;
    RowLists& lists = scratch.lists;
    EdgeList& e = scratch.edges;
    GroupDepth* const groups = scratch.groups;
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    float bounds[4] = {3e38f, 3e38f, -3e38f, -3e38f};
    setUpEdges(e, r, height, bounds);
    if (!(bounds[2] > 0 && bounds[3] > 0 && bounds[0] < width && bounds[1] < height)) return;
    const int column0 = static_cast<int>(std::max(bounds[0], 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(bounds[2], width - 1)) / kBlockWidth,
              block_row0 = static_cast<int>(std::max(bounds[1], 0.0f)) / kBlockHeight,
              block_row1 = static_cast<int>(std::min(bounds[3], height - 1)) / kBlockHeight;
    for (int by = block_row0; by <= block_row1; ++by) {
        int from = column1 + 1, to = -1;  // blocks that may become nearer
        for (int bx = column0; bx <= column1; ++bx)
            if (isBlockOpen(image.at(bx, by), nearest)) {
                from = std::min(from, bx);
                to = bx;
            }
        if (to < 0) continue;
        const int row0 = kBlockHeight * by;
        RowWinding before;  // left of the block at hand
        int used = 0;
        for (int b = from; b <= to; ++b) lists.count[b] = lists.left_count[b] = 0;
        RowPlaces places;
        for (int at = 0; at < e.count; at += 16) {
            placeEdges(e, at, row0, static_cast<float>(kBlockWidth * (to + 1)), places);
            if (e.count - at < 16) places.meets &= (1u << (e.count - at)) - 1;
            for (uint32_t left = places.meets; left != 0; left &= left - 1) {
                const int k = std::countr_zero(left), i = at + k, first = places.first[k], last = places.last[k],
                          begin = places.begin[k], end = places.end[k];
                const float low = places.low[k], high = places.high[k];
                const uint32_t rows = ((1u << end) - 1) & ~((1u << begin) - 1);
                const bool plus = (e.change[i] > 0) != (e.up[i] == 1);
                if (high < static_cast<float>(kBlockWidth * from)) {
                    before.count(rows, plus);
                    continue;
                }
                RowEdge& edge = row_edges[used];
                edge.rows = rows;
                edge.touched_rows = ((2u << last) - 1) & ~((1u << first) - 1);
                edge.plus = plus;
                setUpRow(e, i, row0, width, edge);
                const int b0 = std::max(static_cast<int>(std::max(low, 0.0f)) / kBlockWidth, from),
                          b1 = static_cast<int>(std::min(std::max(high, 0.0f), width + 64)) / kBlockWidth;
                for (int b = b0; b <= std::min(b1, to); ++b)
                    lists.at[b][lists.count[b]++] = static_cast<uint16_t>(used);
                if (b1 < to) lists.left[b1 + 1][lists.left_count[b1 + 1]++] = static_cast<uint16_t>(used);
                ++used;
            }
        }
        for (int bx = from; bx <= to; ++bx) {
            for (int k = 0; k < lists.left_count[bx]; ++k) {
                const RowEdge& edge = row_edges[lists.left[bx][k]];
                before.count(edge.rows, edge.plus);
            }
            if (lists.count[bx] == 0 && ((before.low | before.high) & 0xffffu) == 0) continue;
            DepthBlock& block = image.at(bx, by);
            if (!isBlockOpen(block, nearest)) continue;
            alignas(64) uint32_t covered[kBlockHeight];
            if (coverBlock(row_edges, lists.at[bx], lists.count[bx], before, kBlockWidth * bx, covered))
                updateBlock(image, block, bx, by, covered, groups, count);
        }
    }
}

/// The edges on whose sides groups are drawn otherwise, with their corners' images.
void gatherEdges(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const int8_t* turn, const ClusterImage& image,
                 EdgeList& out) {
    const F f;
    const I i32;
    const hn::Rebind<uint8_t, F> u8;
    alignas(64) uint8_t from[PlaneMesh::kMostEdges + 64], to[PlaneMesh::kMostEdges + 64];
    const uint8_t *left = &mesh.left[c.first_edge], *right = &mesh.right[c.first_edge];
    int count = 0;
    for (uint32_t i = 0; i < c.edges; ++i) {
        const int change = turn[left[i]] - turn[right[i]];
        from[count] = mesh.from[c.first_edge + i];
        to[count] = mesh.to[c.first_edge + i];
        out.change[count] = change;
        count += change != 0;
    }
    const int plain = count;
    for (int i = 0; i < plain; ++i) {
        if (std::abs(out.change[i]) < 2) continue;
        if (count == PlaneMesh::kMostEdges) {
            out.full = true;
            return;
        }
        from[count] = from[i];
        to[count] = to[i];
        out.change[count++] = out.change[i] /= 2;
    }
    std::memset(from + count, 0, 16);
    std::memset(to + count, 0, 16);
    for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(f))) {
        const VI a = hn::PromoteTo(i32, hn::LoadU(u8, from + k)), b = hn::PromoteTo(i32, hn::LoadU(u8, to + k));
        hn::Store(hn::GatherIndex(f, image.x, a), f, out.ax + k);
        hn::Store(hn::GatherIndex(f, image.y, a), f, out.ay + k);
        hn::Store(hn::GatherIndex(f, image.x, b), f, out.bx + k);
        hn::Store(hn::GatherIndex(f, image.y, b), f, out.by + k);
    }
    out.count = count;
}

bool drawClusterKernel(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t index,
                       DrawScratch& scratch) {
    SIGHTLINE_DEBUG_ASSERT(index < mesh.clusters.size());
    ClusterImage& projected = scratch.image;
    EdgeList& edges = scratch.edges;
    GroupDepth* const groups = scratch.groups;
    GroupRect* const rects = scratch.rects;
    const PlaneMesh::Cluster& c = mesh.clusters[index];
    const glm::dvec3 eye = frame.eye - glm::dvec3(c.centre);
    const double away = glm::length(eye);
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {};
    const int facing = faceGroups(mesh, c, glm::vec3(eye), static_cast<float>(away), turn);
    if (facing == 0) return true;
    projectVertices(frame, mesh, c, projected);
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    const float near_w = static_cast<float>(frame.near_w * (1 + 1e-6)), reach = static_cast<float>(away) + c.radius;
    const float w_error = 0x1p-20f * frame.length_w * reach;
    if (!(projected.w_max + w_error > near_w)) return true;
    // The images of vertices: numerators and w are off by 2^-20 of what they are made of at most.
    float r = std::numeric_limits<float>::infinity(), nearest = 1 / near_w * (1 + 1e-5f);
    if (projected.w_min > near_w + w_error) {
        const float farthest = std::max({-projected.x0, projected.x1, -projected.y0, projected.y1, width, height});
        r = 0x1p-20f * (std::max(frame.length_x, frame.length_y) + farthest * frame.length_w) * reach /
                projected.w_min +
            1e-5f;
        if (!(projected.x1 + 1 > 0 && projected.y1 + 1 > 0 && projected.x0 - 1 < width && projected.y0 - 1 < height))
            return true;
    }
    edges.count = 0;
    edges.full = false;
    const bool by_floats = r < 0.25f;
    if (by_floats) {
        nearest = (1 + 1e-5f) / (projected.w_min - w_error);
        if (!isRectOpen(image, projected.x0 - 1, projected.y0 - 1, projected.x1 + 1, projected.y1 + 1, nearest))
            return true;
        gatherEdges(mesh, c, turn, projected, edges);
    } else if (!cutEdges(frame, mesh, c, turn, width, height, edges, rects, r, nearest)) {
        return false;
    }
    if (edges.full) return false;
    if (edges.count == 0) return true;
    for (int i = 0; frame.sign < 0 && i < edges.count; ++i) edges.change[i] = -edges.change[i];
    int count = 0;
    GroupPlanes& planes = scratch.planes;
    planesOf(frame, mesh, c, eye, width, height, planes);
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        const size_t at = size_t{c.first_group} + g;
        GroupDepth& of = groups[count++];
        of.plane = {planes.a[g], planes.b[g], planes.c[g]};
        of.least = of.plane.c - 4.0f * (std::abs(of.plane.a) + std::abs(of.plane.b));
        of.index = DepthBlock::kNoPlane;
        of.rect = by_floats ? GroupRect() : rects[g];
        for (uint32_t k = 0; by_floats && k < mesh.corner_count[at]; ++k) {
            const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
            of.rect.grow(projected.x[v], projected.y[v]);
        }
    }
    rasterize(image, scratch, r, nearest, count);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace sightline::bench {

HWY_EXPORT(drawClusterKernel);
HWY_EXPORT(imageOfKernel);
HWY_EXPORT(isOpenKernel);

AskedBox askedBox(const Screen& screen, const glm::dvec3& centre, const glm::dvec3& half) {
    AskedBox out;
    const glm::dvec4 at(centre, 1);
    const auto take = [&](const glm::dvec4& row, float(&to)[4]) {
        for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(row[axis]);
        to[3] = static_cast<float>(glm::dot(row, at));
    };
    take(screen.x, out.x);
    take(screen.y, out.y);
    take(screen.w, out.w);
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

bool isOpen(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box) {
    return HWY_DYNAMIC_DISPATCH(isOpenKernel)(image, x0, y0, x1, y1, nearness, box);
}

}  // namespace sightline::bench

#endif  // HWY_ONCE
