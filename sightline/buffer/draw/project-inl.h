// Which groups of a cluster face the eye, where its vertices are in the image, and the edges between its groups there.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_PROJECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_PROJECT_INL_H
#undef SIGHTLINE_BUFFER_DRAW_PROJECT_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_PROJECT_INL_H
#endif

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "sightline/buffer/draw/frame.h"
#include "sightline/buffer/draw/scratch.h"
#include "sightline/buffer/tile_ops-inl.h"
#include "sightline/geom/occluder.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

using F = F16;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using VU = hn::Vec<U>;

/// A row over vertices relative to the cluster's centre: m holds it, in floats, and its value at the centre.
struct LocalRow {
    float x, y, z, at_centre;
};

inline LocalRow rowOf(const glm::dvec4& row, const glm::dvec3& centre) {
    return {static_cast<float>(row.x), static_cast<float>(row.y), static_cast<float>(row.z),
            static_cast<float>(glm::dot(glm::dvec3(row), centre) + row.w)};
}

HWY_INLINE VF apply(const LocalRow& row, VF x, VF y, VF z) {
    const F f;
    return hn::Add(hn::Add(hn::Mul(hn::Set(f, row.x), x), hn::Mul(hn::Set(f, row.y), y)),
                   hn::Add(hn::Mul(hn::Set(f, row.z), z), hn::Set(f, row.at_centre)));
}

/// How many groups show their front, are drawn from behind, and may show either.
struct Facing {
    int fronts = 0, backs = 0, doubts = 0;
};

/// Which groups surely show their front (1) or, drawn from both sides, their back (-1) to the eye; 0: all others. A group
/// that is not 0 has no polygon that faces otherwise, so that no winding number is less than 0.
/// @param eye    from the part's centre
/// @param away   its distance
/// @param doubt  becomes 1 for each group that may show its front and has 0, else 0; or null
inline Facing faceGroups(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Part& c,
                         const glm::vec3& eye, float away, int8_t* turn, int8_t* doubt) {
    const F f;
    Facing out;
    // A direction, of length 1, has no place.
    const float place = frame.perspective ? 1.0f : 0.0f, reach = frame.perspective ? away + c.radius : 1.0f;
    for (uint32_t g = 0; g < c.groups; g += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_group} + g;
        const VF h = hn::Sub(hn::Add(hn::Add(hn::Mul(hn::LoadU(f, &mesh.nx[at]), hn::Set(f, eye.x)),
                                             hn::Mul(hn::LoadU(f, &mesh.ny[at]), hn::Set(f, eye.y))),
                                     hn::Mul(hn::LoadU(f, &mesh.nz[at]), hn::Set(f, eye.z))),
                             hn::Mul(hn::Set(f, place), hn::LoadU(f, &mesh.nd[at])));
        // What floats may be off by, what vertices lie off the plane, and what a triangle may lean.
        const VF off =
            hn::Mul(hn::Set(f, place), hn::Add(hn::LoadU(f, &mesh.thick[at]), hn::Set(f, frame.place_error)));
        const VF room =
            hn::Add(off, hn::Mul(hn::Add(hn::LoadU(f, &mesh.tilt[at]), hn::Set(f, 0x1p-20f)), hn::Set(f, reach)));
        const auto front = hn::Gt(h, room);
        const auto away_from = hn::Lt(h, hn::Neg(room));
        const VF back = hn::IfThenElseZero(away_from, hn::LoadU(f, &mesh.both[at]));
        const VF turns = hn::IfThenElse(front, hn::Set(f, 1.0f), hn::Neg(back));
        const hn::Rebind<int8_t, F> i8;
        const auto store = [&](VF v, int8_t* to)
                               HWY_ATTR { hn::StoreU(hn::DemoteTo(i8, hn::ConvertTo(I(), v)), i8, to); };
        store(turns, turn + g);
        if (doubt) {
            const auto is_real = hn::Lt(hn::Iota(f, static_cast<float>(g)), hn::Set(f, static_cast<float>(c.groups)));
            const auto doubtful = hn::And(is_real, hn::Not(hn::Or(front, away_from)));
            store(hn::IfThenElseZero(doubtful, hn::Set(f, 1.0f)), doubt + g);
            out.doubts += static_cast<int>(hn::CountTrue(f, doubtful));
        }
        out.fronts += static_cast<int>(hn::CountTrue(f, front));
        out.backs += static_cast<int>(hn::CountTrue(f, hn::Ne(back, hn::Zero(f))));
    }
    return out;
}

/// Numerators and w are off by 2^-20 of what they are made of at most, and by what the object's place is.
/// @param errors  what x, y and w may be off by
/// @param touch   what edges touch beside themselves  [pixels]
inline void projectVertices(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Part& c,
                            const glm::vec3& errors, float touch, PartImage& out) {
    const F f;
    const glm::dvec3 centre(c.centre);
    const LocalRow rx = rowOf(frame.x, centre), ry = rowOf(frame.y, centre), rw = rowOf(frame.w, centre);
    const VF error = hn::Set(f, errors.z), own = hn::Set(f, std::max(errors.x, errors.y)),
             more = hn::Set(f, 1e-5f + touch);
    VF x0 = hn::Set(f, 3e38f), y0 = x0, w0 = x0, x1 = hn::Set(f, -3e38f), y1 = x1, w1 = x1, r1 = hn::Zero(f);
    for (uint32_t i = 0; i < c.vertices; i += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_vertex} + i;
        const VF x = hn::LoadU(f, &mesh.x[at]), y = hn::LoadU(f, &mesh.y[at]), z = hn::LoadU(f, &mesh.z[at]);
        const VF w = apply(rw, x, y, z);
        const VF px = hn::Div(apply(rx, x, y, z), w), py = hn::Div(apply(ry, x, y, z), w);
        const VF far = hn::Max(hn::Abs(px), hn::Abs(py));
        const VF r = hn::Add(hn::Div(hn::Add(own, hn::Mul(far, error)), hn::Sub(w, error)), more);
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

/// All vertices of a part's cluster, by their own positions.
/// @param guard  what has less of near.h does not matter
inline void projectExactly(const ObjectFrame& frame, const Occluder& occluder, const PlaneMesh::Part& c, double guard,
                           ExactImage& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const OccluderCluster& cluster = occluder.clusters[c.cluster];
    for (uint32_t i = 0; i < cluster.vertex_count; i += static_cast<uint32_t>(hn::Lanes(d))) {
        const size_t at = size_t{cluster.first_vertex} + i;
        const auto load = [&](const Array<float>& from) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, &from[at])); };
        const auto x = load(occluder.x), y = load(occluder.y), z = load(occluder.z);
        const auto over = [&](const glm::dvec4& row) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, row.x), x), hn::Mul(hn::Set(d, row.y), y)),
                           hn::Add(hn::Mul(hn::Set(d, row.z), z), hn::Set(d, row.w)));
        };
        const auto w = over(frame.w);
        hn::Store(hn::Div(over(frame.x), w), d, out.x + i);
        hn::Store(hn::Div(over(frame.y), w), d, out.y + i);
        hn::Store(w, d, out.w + i);
        hn::Store(hn::Sub(over(frame.near), hn::Set(d, guard)), d, out.near + i);
    }
}

/// The edges on whose sides groups are drawn otherwise, with their corners' images.
inline void gatherEdges(const PlaneMesh& mesh, const PlaneMesh::Part& c, const int8_t* turn, const PartImage& image,
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

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
