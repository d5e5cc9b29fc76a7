// What a view makes of a part: its edges, and the depth of its groups.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_CLUSTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_CLUSTER_INL_H
#undef SIGHTLINE_BUFFER_DRAW_CLUSTER_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_CLUSTER_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/buffer/draw/update-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// What a view makes of a part.
struct PartView {
    glm::dvec3 eye;    ///< from the part's centre; in parallel projection the way to it
    float away;        ///< the eye from the centre
    glm::vec3 errors;  ///< what x, y and w may be off by
    float touch;       ///< what edges touch beside themselves  [pixels]
    bool by_floats;    ///< images of vertices are known well enough in floats
    float nearest;     ///< nothing of it is nearer, once edges are found  [nearness]
    float farthest;    ///< nothing of it is farther                       [nearness]
};

/// The least and the most of a row over a part's box.
struct RowRange {
    double least, most;

    RowRange(const glm::dvec4& row, float length, const PlaneMesh::Part& c, float place_error) {
        const double at = glm::dot(glm::dvec3(row), glm::dvec3(c.centre)) + row.w,
                     to = glm::dot(glm::abs(glm::dvec3(row)), glm::dvec3(c.half)),
                     error = double{length} * place_error + 0x1p-50 * (std::abs(at) + std::abs(row.w));
        least = at - to - error;
        most = at + to + error;
    }
};

inline PartView viewOf(const ObjectFrame& frame, const PlaneMesh::Part& c, float touch) {
    PartView out{};
    out.eye = frame.perspective ? frame.eye - glm::dvec3(c.centre) : frame.eye;
    out.away = static_cast<float>(glm::length(out.eye));
    out.touch = touch;
    // In parallel projection what is far aside is off by as much: rows are taken over the centre.
    const auto errorOf = [&](const glm::dvec4& row, float length) {
        const float at = std::abs(static_cast<float>(glm::dot(glm::dvec3(row), glm::dvec3(c.centre)) + row.w));
        return 0x1p-20f * (length * c.radius + at) + length * frame.place_error;
    };
    out.errors = {errorOf(frame.x, frame.length_x), errorOf(frame.y, frame.length_y), errorOf(frame.w, frame.length_w)};
    return out;
}

/// @param guard  what has less of near.h does not matter
/// @returns whether there is anything else
inline bool project(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Part& c, double guard,
                    PartView& view, PartImage& out) {
    const RowRange near(frame.near, frame.length_near, c, frame.place_error);
    if (near.most < guard) return false;
    projectVertices(frame, mesh, c, view.errors, view.touch, out);
    view.by_floats = near.least > frame.near_guard && out.w_min > view.errors.z && out.r_max < 0.25f + view.touch;
    if (frame.perspective) {
        view.farthest = (1 - 1e-6f) / (out.w_max + view.errors.z);
        if (!(view.farthest > 0)) view.farthest = 0;
    } else {
        const RowRange depth(frame.d, frame.length_d, c, frame.place_error);
        const double w = frame.w.w, size = 0x1p-22 * (std::abs(depth.least) + std::abs(depth.most)) / w;
        view.farthest = static_cast<float>(depth.least / w - size);
        view.nearest = static_cast<float>(depth.most / w + size);
    }
    return true;
}

/// kOutside: it is not in the image. kHidden: it is not open there. kNone: no edges. kUnknown: there is no room for them.
enum class Edges { kOutside, kHidden, kNone, kUnknown, kSome };

/// Gathers the edges on whose sides groups are drawn otherwise.
/// @param least  what is open to it counts as open, too
inline Edges findEdges(const DepthTiles& tiles, const ObjectFrame& frame, const Occluder& occluder,
                       const PlaneMesh::Part& c, PartView& view, double guard, const int8_t* turn, DrawScratch& scratch,
                       float least = -std::numeric_limits<float>::infinity()) {
    const PlaneMesh& mesh = occluder.planes;
    const PartImage& projected = scratch.image;
    EdgeList& edges = scratch.edges;
    const float width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
    edges.count = 0;
    edges.full = false;
    if (view.by_floats) {
        const float by = 1 + view.touch, x0 = projected.x0 - by, y0 = projected.y0 - by, x1 = projected.x1 + by,
                    y1 = projected.y1 + by;
        if (frame.perspective) view.nearest = (1 + 1e-5f) / (projected.w_min - view.errors.z);
        if (!(x1 > 0 && y1 > 0 && x0 < width && y0 < height)) return Edges::kOutside;
        if (!isRectOpen(tiles, x0, y0, x1, y1, std::max(least, view.nearest))) return Edges::kHidden;
        gatherEdges(mesh, c, turn, projected, edges);
    } else {
        projectExactly(frame, occluder, c, guard, scratch.exact);
        const float parallel = view.nearest;
        if (!cutEdges(frame, scratch.exact, occluder, c, turn, width, height, view.touch, edges, scratch.rects,
                      view.nearest))
            return Edges::kUnknown;
        if (!frame.perspective) view.nearest = parallel;
    }
    if (edges.full) return Edges::kUnknown;
    for (int i = 0; frame.sign < 0 && i < edges.count; ++i) edges.change[i] = -edges.change[i];
    return edges.count == 0 ? Edges::kNone : Edges::kSome;
}

/// Where a group may be in the image.
inline GroupRect rectOf(const PlaneMesh& mesh, const PlaneMesh::Part& c, uint32_t group, bool by_floats,
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
int groupDepths(const DepthTiles& tiles, const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Part& c,
                const PartView& view, const int8_t* turn, DrawScratch& scratch) {
    GroupPlanes& planes = scratch.planes;
    planesOf<kNearest>(frame, mesh, c, view.eye, static_cast<float>(tiles.width), static_cast<float>(tiles.height),
                       planes);
    int count = 0;
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        GroupDepth& of = scratch.groups[count++];
        of.a = planes.a[g];
        of.b = planes.b[g];
        of.c = planes.c[g];
        const float lean = 4.0f * (std::abs(of.a) + std::abs(of.b));
        of.bound = kNearest ? of.c + lean : of.c - lean;
        // Seen nearly edge-on its nearness has no bound but the part's.
        if (kNearest && !(of.bound < 1e30f && lean < 1e30f)) {
            of.a = of.b = 0;
            of.bound = std::numeric_limits<float>::infinity();
        }
        of.index = DepthTiles::kNone;
        of.rect = rectOf(mesh, c, g, view.by_floats, scratch).wider(5);
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
