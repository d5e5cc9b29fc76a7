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
#include "bench/onepass/look-inl.h"
#include "bench/onepass/rows-inl.h"

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
/// @param doubt  becomes 1 for each group that may show its front and has 0; or null
/// @returns how many are not 0
int faceGroups(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const glm::vec3& eye, float away, int8_t* turn,
               int8_t* doubt) {
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
        const auto away_from = hn::Lt(h, hn::Neg(room));
        const VF back = hn::IfThenElseZero(away_from, hn::LoadU(f, &mesh.both[at]));
        const VF turns = hn::IfThenElse(front, hn::Set(f, 1.0f), hn::Neg(back));
        const auto store = [&](VF v, int8_t* to) HWY_ATTR {
            const hn::Rebind<int8_t, F> i8;
            hn::StoreU(hn::DemoteTo(i8, hn::ConvertTo(I(), v)), i8, to);
        };
        store(turns, turn + g);
        if (doubt) store(hn::IfThenElse(hn::Or(front, away_from), hn::Zero(f), hn::Set(f, 1.0f)), doubt + g);
        count += static_cast<int>(hn::CountTrue(f, hn::Ne(turns, hn::Zero(f))));
    }
    return count;
}

/// Numerators and w are off by 2^-20 of what they are made of at most.
/// @param reach    no vertex is farther from the eye
/// @param w_error  what w may be off by
void projectVertices(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, float reach,
                     float w_error, ClusterImage& out) {
    const F f;
    const glm::dvec3 centre(c.centre);
    const Row rx = rowOf(frame.x, centre), ry = rowOf(frame.y, centre), rw = rowOf(frame.w, centre);
    const VF error = hn::Set(f, w_error), own = hn::Set(f, 0x1p-20f * std::max(frame.length_x, frame.length_y) * reach);
    VF x0 = hn::Set(f, 3e38f), y0 = x0, w0 = x0, x1 = hn::Set(f, -3e38f), y1 = x1, w1 = x1, r1 = hn::Zero(f);
    for (uint32_t i = 0; i < c.vertices; i += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_vertex} + i;
        const VF x = hn::LoadU(f, &mesh.x[at]), y = hn::LoadU(f, &mesh.y[at]), z = hn::LoadU(f, &mesh.z[at]);
        const VF w = apply(rw, x, y, z);
        const VF px = hn::Div(apply(rx, x, y, z), w), py = hn::Div(apply(ry, x, y, z), w);
        const VF far = hn::Max(hn::Abs(px), hn::Abs(py));
        const VF r = hn::Add(hn::Div(hn::Add(own, hn::Mul(far, error)), hn::Sub(w, error)), hn::Set(f, 1e-5f));
        hn::Store(px, f, out.x + i);
        hn::Store(py, f, out.y + i);
        hn::Store(w, f, out.w + i);
        hn::Store(r, f, out.r + i);
        x0 = hn::Min(x0, px);
        x1 = hn::Max(x1, px);
        y0 = hn::Min(y0, py);
        y1 = hn::Max(y1, py);
        w0 = hn::Min(w0, w);
        w1 = hn::Max(w1, w);
        r1 = hn::Max(r1, r);
    }
    const auto least = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(f, v)); };
    const auto most = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(f, v)); };
    out.x0 = least(x0);
    out.y0 = least(y0);
    out.w_min = least(w0);
    out.x1 = most(x1);
    out.y1 = most(y1);
    out.w_max = most(w1);
    out.r_max = most(r1);
}

void projectExactly(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, ExactImage& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    for (uint32_t i = 0; i < c.vertices; i += static_cast<uint32_t>(hn::Lanes(d))) {
        const size_t at = size_t{c.first_vertex} + i;
        const auto load = [&](const std::vector<float>& from, float centre) HWY_ATTR {
            return hn::Add(hn::PromoteTo(d, hn::LoadU(f, &from[at])), hn::Set(d, static_cast<double>(centre)));
        };
        const auto x = load(mesh.x, c.centre.x), y = load(mesh.y, c.centre.y), z = load(mesh.z, c.centre.z);
        const auto over = [&](const glm::dvec4& row) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, row.x), x), hn::Mul(hn::Set(d, row.y), y)),
                           hn::Add(hn::Mul(hn::Set(d, row.z), z), hn::Set(d, row.w)));
        };
        const auto w = over(frame.w);
        hn::Store(hn::Div(over(frame.x), w), d, out.x + i);
        hn::Store(hn::Div(over(frame.y), w), d, out.y + i);
        hn::Store(w, d, out.w + i);
    }
}

uint32_t clustersInViewKernel(float width, float height, const ObjectFrame& frame, const PlaneMesh& mesh,
                              uint32_t* out) {
    const F f;
    // What is in the image is on the positive side of all of these.
    const glm::dvec4 nearer(0, 0, 0, -frame.near_w * (1 - 1e-6));
    const glm::vec4 sides[5] = {glm::vec4(frame.x), glm::vec4(frame.w * static_cast<double>(width) - frame.x),
                                glm::vec4(frame.y), glm::vec4(frame.w * static_cast<double>(height) - frame.y),
                                glm::vec4(frame.w + nearer)};
    uint32_t count = 0;
    for (size_t i = 0; i < mesh.clusters.size(); i += hn::Lanes(f)) {
        VF box[6];
        for (int k = 0; k < 6; ++k) box[k] = hn::LoadU(f, &mesh.box[k][i]);
        VF least = hn::Set(f, 3e38f);
        for (const glm::vec4& side : sides) {
            // With what rounding of its summands may be off by.
            const float sum = std::abs(side.x) + std::abs(side.y) + std::abs(side.z);
            VF most = hn::Set(f, side.w + 0x1p-20f * (2 * sum * mesh.reach + std::abs(side.w)));
            for (int k = 0; k < 3; ++k)
                most = hn::Add(most, hn::Add(hn::Mul(hn::Set(f, side[k]), box[k]),
                                             hn::Mul(hn::Set(f, std::abs(side[k])), box[3 + k])));
            least = hn::Min(least, most);
        }
        uint8_t bytes[8] = {};
        hn::StoreMaskBits(f, hn::Ge(least, hn::Zero(f)), bytes);
        uint32_t bits = bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
        if (mesh.clusters.size() - i < 16) bits &= (1u << (mesh.clusters.size() - i)) - 1;
        for (; bits != 0; bits &= bits - 1)
            out[count++] = static_cast<uint32_t>(i) + static_cast<uint32_t>(std::countr_zero(bits));
    }
    return count;
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
        hn::Store(hn::Max(hn::GatherIndex(f, image.r, a), hn::GatherIndex(f, image.r, b)), f, out.r + k);
    }
    out.count = count;
}

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

/// Whether a rectangle of the image, which may reach beside it, is open to a nearness.
bool isRectangleOpen(DepthBlocks& image, const GroupRect& rect, float nearness) {
    const float right = static_cast<float>(image.width - 1), bottom = static_cast<float>(image.height - 1);
    if (!(rect.x1 >= 0 && rect.y1 >= 0 && rect.x0 <= right + 1 && rect.y0 <= bottom + 1)) return false;
    const auto pixel = [](float v, float most) { return static_cast<int>(std::clamp(v, 0.0f, most)); };
    return isOpenKernel(image, pixel(rect.x0, right), pixel(rect.y0, bottom), pixel(rect.x1, right),
                        pixel(rect.y1, bottom), nearness, nullptr);
}

/// Whether a corner of a group that faces the eye is open. That an object is seen shows soonest there.
bool isCornerOpen(DepthBlocks& image, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const int8_t* turn,
                  float near_w, const ClusterImage& projected) {
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        const size_t at = size_t{c.first_group} + g;
        for (uint32_t k = 0; k < std::min(mesh.corner_count[at], 4u); ++k) {
            const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
            const float x = projected.x[v], y = projected.y[v], w = projected.w[v];
            if (w > near_w && x > 0 && y > 0 && x < width && y < height &&
                image.claim(static_cast<int>(x), static_cast<int>(y)) * w < 1)
                return true;
        }
    }
    return false;
}

bool lookKernel(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t index,
                const AskedBox& box, DrawScratch& scratch) {
    SIGHTLINE_DEBUG_ASSERT(index < mesh.clusters.size());
    const PlaneMesh::Cluster& c = mesh.clusters[index];
    ClusterView view = viewOf(frame, frame.near_w * (1 - 1e-6), c);
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {}, doubt[PlaneMesh::kNoGroup + 1] = {};
    const int facing = faceGroups(mesh, c, glm::vec3(view.eye), view.away, turn, doubt);
    const bool is_doubtful = std::find(doubt, doubt + c.groups, 1) != doubt + c.groups;
    if ((facing == 0 && !is_doubtful) || !project(frame, mesh, c, view, scratch.image)) return false;
    if (isCornerOpen(image, mesh, c, turn, view.near_w, scratch.image)) return true;
    const Edges found = findEdges(image, frame, mesh, c, view, turn, scratch);
    if (found == Edges::kOutside) return false;
    if (found == Edges::kUnknown || (is_doubtful && !view.by_floats)) return true;
    for (uint32_t g = 0; is_doubtful && g < c.groups; ++g)
        if (doubt[g] != 0 && isRectangleOpen(image, rectOf(mesh, c, g, true, scratch), view.nearest)) return true;
    if (found == Edges::kNone) return false;
    const int count = groupDepths<true>(image, frame, mesh, c, view.eye, turn, view.by_floats, scratch);
    return isOutlineOpen(image, scratch, view.nearest, count, box);
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
