// Flat lists of bounds against view volumes, sixteen at a time: spheres, boxes, oriented boxes, k-DOPs; many volumes in one pass.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/flat_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/frustum/flat_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef SIGHTLINE_STUDIES_FRUSTUM_FLAT_BOUNDS_ONCE
#define SIGHTLINE_STUDIES_FRUSTUM_FLAT_BOUNDS_ONCE
namespace sightline::studies::detail {

/// Coordinates, coefficients and the some fifteen steps of a sum round by 2^-23 each, of at most `size`.
constexpr double kFlatRounding = 0x1p-18;

/// A plane as the kernels use it: outside if most + outer < 0, surely inside if least + inner >= 0.
struct FlatPlane {
    float n[3];
    float outer, inner;
};

/// @param terms  the sum of the sizes of all terms of a bound, in sums of |n| times its reach
inline FlatPlane flatPlane(const glm::dvec4& p, const glm::dvec3& eye, const glm::dvec3& origin, double reach,
                           double terms) {
    const double shift = glm::dot(glm::dvec3(p), origin - eye);
    const double sides = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    const double far_away = std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z) + std::abs(eye.x) +
                            std::abs(eye.y) + std::abs(eye.z);
    const double margin =
        kFlatRounding * (std::abs(p.w) + std::abs(shift) + terms * sides * reach) + 0x1p-48 * far_away;
    return {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
            static_cast<float>(p.w + shift + margin),
            static_cast<float>(p.w + shift - margin)};
}

/// The corners of boxes that are farthest inside and farthest outside a plane.
struct BoxPlane {
    FlatPlane plane;
    const float* most[3];
    const float* least[3];
};

inline BoxPlane boxPlane(const glm::dvec4& p, const glm::dvec3& eye, const BoxArrays& boxes) {
    BoxPlane out{flatPlane(p, eye, boxes.origin, boxes.reach, 1.0), {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const bool up = p[axis] >= 0.0;
        out.most[axis] = up ? boxes.max[axis] : boxes.min[axis];
        out.least[axis] = up ? boxes.min[axis] : boxes.max[axis];
    }
    return out;
}

/// Sums of three slabs that limit how far DOPs reach along a normal; the least of them is taken.
struct DopPlane {
    static constexpr int kSums = 4;
    FlatPlane plane;
    float weight[kSums][3];
    const float* most[kSums][3];
    const float* least[kSums][3];
};

inline DopPlane dopPlane(const glm::dvec4& p, const glm::dvec3& eye, const DopArrays& dops) {
    // No weight is larger than the sum of |n|, a diagonal slab is at three times the reach.
    DopPlane out{flatPlane(p, eye, dops.origin, dops.reach, 10.0), {}, {}, {}};
    struct Choice {
        double looseness;  // how far a ball of radius 1 seems to reach
        int slabs[3];
        glm::dvec3 weight;
    };
    std::array<Choice, 35> choices;
    size_t count = 0;
    for (int i = 0; i < Dop::kSlabs; ++i)
        for (int j = i + 1; j < Dop::kSlabs; ++j)
            for (int k = j + 1; k < Dop::kSlabs; ++k) {
                const glm::dmat3 m{Dop::kDirections[i], Dop::kDirections[j], Dop::kDirections[k]};
                if (std::abs(glm::determinant(m)) < 0.5) continue;
                Choice& c = choices[count++] = {0.0, {i, j, k}, glm::inverse(m) * glm::dvec3(p)};
                for (int s = 0; s < 3; ++s)
                    c.looseness += std::abs(c.weight[s]) * glm::length(Dop::kDirections[c.slabs[s]]);
            }
    // The first is the box's own corner, so that a DOP never keeps what its box would not.
    std::stable_sort(choices.begin() + 1, choices.begin() + count,
                     [](const Choice& a, const Choice& b) { return a.looseness < b.looseness; });
    for (int sum = 0; sum < DopPlane::kSums; ++sum)
        for (int s = 0; s < 3; ++s) {
            const int slab = choices[sum].slabs[s];
            const double weight = choices[sum].weight[s];
            out.weight[sum][s] = static_cast<float>(weight);
            out.most[sum][s] = weight >= 0.0 ? dops.max[slab] : dops.min[slab];
            out.least[sum][s] = weight >= 0.0 ? dops.min[slab] : dops.max[slab];
        }
    return out;
}

/// A plane across an axis of the world: the bound that decides, and which way.
struct AxisPlane {
    const float* bound;
    float sign, outer;
};

constexpr uint32_t kMost = ViewVolume::kMostPlanes;

struct RefinedPlanes {
    BoxPlane planes[kMost], crossed[RefinedVolume::kMostCrossed];
    AxisPlane axes[6];
    uint32_t plane_count = 0, axis_count = 0, crossed_count = 0;
};

}  // namespace sightline::studies::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using detail::BoxPlane;
using detail::DopPlane;
using detail::FlatPlane;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V scaled(float factor, const float* values, size_t i) {
    const D d;
    return hn::Mul(hn::Set(d, factor), hn::LoadU(d, values + i));
}

HWY_INLINE V dot(const float* n, const float* const* v, size_t i) {
    return hn::Add(hn::Add(scaled(n[0], v[0], i), scaled(n[1], v[1], i)), scaled(n[2], v[2], i));
}

/// How far bounds reach along a plane's normal: most() and least(), one class per kind of bound.
struct SphereSums {
    const SphereArrays& arrays;
    FlatPlane planes[detail::kMost];

    SphereSums(const ViewVolume& volume, const SphereArrays& from) : arrays(from) {
        for (uint32_t k = 0; k < volume.count; ++k)
            planes[k] = detail::flatPlane(volume.planes[k], volume.eye, from.origin, from.reach, 2.0);
    }
    HWY_INLINE const FlatPlane& plane(uint32_t k) const { return planes[k]; }
    HWY_INLINE V most(uint32_t k, size_t i) const {
        return hn::Add(dot(planes[k].n, arrays.center, i), hn::LoadU(D(), arrays.radius + i));
    }
    HWY_INLINE V least(uint32_t k, size_t i) const {
        return hn::Sub(dot(planes[k].n, arrays.center, i), hn::LoadU(D(), arrays.radius + i));
    }
};

struct BoxSums {
    BoxPlane planes[detail::kMost];

    BoxSums(const ViewVolume& volume, const BoxArrays& from) {
        for (uint32_t k = 0; k < volume.count; ++k) planes[k] = detail::boxPlane(volume.planes[k], volume.eye, from);
    }
    HWY_INLINE const FlatPlane& plane(uint32_t k) const { return planes[k].plane; }
    HWY_INLINE V most(uint32_t k, size_t i) const { return dot(planes[k].plane.n, planes[k].most, i); }
    HWY_INLINE V least(uint32_t k, size_t i) const { return dot(planes[k].plane.n, planes[k].least, i); }
};

struct OrientedSums {
    const OrientedBoxArrays& arrays;
    FlatPlane planes[detail::kMost];

    OrientedSums(const ViewVolume& volume, const OrientedBoxArrays& from) : arrays(from) {
        for (uint32_t k = 0; k < volume.count; ++k)
            planes[k] = detail::flatPlane(volume.planes[k], volume.eye, from.origin, from.reach, 4.0);
    }
    HWY_INLINE const FlatPlane& plane(uint32_t k) const { return planes[k]; }
    HWY_INLINE V radius(uint32_t k, size_t i) const {
        V sum = hn::Abs(dot(planes[k].n, arrays.half[0], i));
        sum = hn::Add(sum, hn::Abs(dot(planes[k].n, arrays.half[1], i)));
        return hn::Add(sum, hn::Abs(dot(planes[k].n, arrays.half[2], i)));
    }
    HWY_INLINE V most(uint32_t k, size_t i) const { return hn::Add(dot(planes[k].n, arrays.center, i), radius(k, i)); }
    HWY_INLINE V least(uint32_t k, size_t i) const { return hn::Sub(dot(planes[k].n, arrays.center, i), radius(k, i)); }
};

struct DopSums {
    DopPlane planes[detail::kMost];

    DopSums(const ViewVolume& volume, const DopArrays& from) {
        for (uint32_t k = 0; k < volume.count; ++k) planes[k] = detail::dopPlane(volume.planes[k], volume.eye, from);
    }
    HWY_INLINE const FlatPlane& plane(uint32_t k) const { return planes[k].plane; }
    // Written so that a sum that is no number stays.
    HWY_INLINE V most(uint32_t k, size_t i) const {
        V best = dot(planes[k].weight[0], planes[k].most[0], i);
        for (int sum = 1; sum < DopPlane::kSums; ++sum) {
            const V other = dot(planes[k].weight[sum], planes[k].most[sum], i);
            best = hn::IfThenElse(hn::Ge(other, best), best, hn::IfThenElse(hn::IsNaN(best), best, other));
        }
        return best;
    }
    HWY_INLINE V least(uint32_t k, size_t i) const {
        V best = dot(planes[k].weight[0], planes[k].least[0], i);
        for (int sum = 1; sum < DopPlane::kSums; ++sum) {
            const V other = dot(planes[k].weight[sum], planes[k].least[sum], i);
            best = hn::IfThenElse(hn::Le(other, best), best, hn::IfThenElse(hn::IsNaN(best), best, other));
        }
        return best;
    }
};

template <class Sums>
void masksOf(const Sums& sums, uint32_t planes, size_t count, uint32_t* masks) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        auto crossed = hn::Zero(u);
        M outside = hn::FirstN(d, 0);
        for (uint32_t k = 0; k < planes; ++k) {
            const FlatPlane& p = sums.plane(k);
            outside = hn::Or(outside, hn::Lt(hn::Add(sums.most(k, i), hn::Set(d, p.outer)), hn::Zero(d)));
            const M inside = hn::Ge(hn::Add(sums.least(k, i), hn::Set(d, p.inner)), hn::Zero(d));
            crossed = hn::Or(crossed, hn::IfThenZeroElse(hn::RebindMask(u, inside), hn::Set(u, 1u << k)));
        }
        hn::StoreU(hn::IfThenElse(hn::RebindMask(u, outside), hn::Set(u, kOutsideMask), crossed), u, masks + i);
    }
}

template <class Sums>
HWY_INLINE M keptBy(const Sums& sums, uint32_t planes, size_t i, M kept) {
    const D d;
    for (uint32_t k = 0; k < planes; ++k)
        kept = hn::AndNot(hn::Lt(hn::Add(sums.most(k, i), hn::Set(d, sums.plane(k).outer)), hn::Zero(d)), kept);
    return kept;
}

template <class Sums>
size_t keep(const Sums& sums, uint32_t planes, size_t count, uint32_t* kept) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    size_t found = 0;
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
        const M inside = keptBy(sums, planes, i, hn::FirstN(d, count - i));
        const auto index = hn::Iota(u, static_cast<uint32_t>(i));
        found += hn::CompressStore(index, hn::RebindMask(u, inside), u, kept + found);
    }
    return found;
}

#define SIGHTLINE_FLAT_KERNELS(Name, Arrays, Sums)                                      \
    void test##Name(const ViewVolume& volume, const Arrays& arrays, uint32_t* masks) {  \
        masksOf(Sums(volume, arrays), volume.count, arrays.count, masks);               \
    }                                                                                   \
    size_t cull##Name(const ViewVolume& volume, const Arrays& arrays, uint32_t* kept) { \
        return keep(Sums(volume, arrays), volume.count, arrays.count, kept);            \
    }
SIGHTLINE_FLAT_KERNELS(Spheres, SphereArrays, SphereSums)
SIGHTLINE_FLAT_KERNELS(Boxes, BoxArrays, BoxSums)
SIGHTLINE_FLAT_KERNELS(OrientedBoxes, OrientedBoxArrays, OrientedSums)
SIGHTLINE_FLAT_KERNELS(Dops, DopArrays, DopSums)
#undef SIGHTLINE_FLAT_KERNELS

HWY_INLINE V mostOf(const BoxPlane& p, size_t i) {
    return hn::Add(dot(p.plane.n, p.most, i), hn::Set(D(), p.plane.outer));
}

HWY_INLINE M isLarge(const BoxArrays& boxes, size_t i, float large) {
    const D d;
    M any = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
        const V side = hn::Sub(hn::LoadU(d, boxes.max[axis] + i), hn::LoadU(d, boxes.min[axis] + i));
        any = hn::Or(any, hn::Ge(side, hn::Set(d, large)));
    }
    return any;
}

size_t cullRefined(const detail::RefinedPlanes& refined, const BoxArrays& boxes, float large, uint32_t* kept) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    const V zero = hn::Zero(d);
    size_t found = 0;
    for (size_t i = 0; i < boxes.count; i += hn::Lanes(d)) {
        M inside = hn::FirstN(d, boxes.count - i);
        for (uint32_t k = 0; k < refined.plane_count; ++k)
            inside = hn::AndNot(hn::Lt(mostOf(refined.planes[k], i), zero), inside);
        if (hn::AllFalse(d, inside)) continue;
        const M asked = hn::And(inside, isLarge(boxes, i, large));
        if (!hn::AllFalse(d, asked)) {
            M left = asked;
            for (uint32_t k = 0; k < refined.axis_count; ++k) {
                const detail::AxisPlane& p = refined.axes[k];
                left = hn::AndNot(hn::Lt(hn::Add(scaled(p.sign, p.bound, i), hn::Set(d, p.outer)), zero), left);
            }
            for (uint32_t k = 0; k < refined.crossed_count && !hn::AllFalse(d, left); ++k)
                left = hn::AndNot(hn::Lt(mostOf(refined.crossed[k], i), zero), left);
            inside = hn::Or(left, hn::AndNot(asked, inside));
        }
        const auto index = hn::Iota(u, static_cast<uint32_t>(i));
        found += hn::CompressStore(index, hn::RebindMask(u, inside), u, kept + found);
    }
    return found;
}

void testVolumesKernel(std::span<const ViewVolume> volumes, const BoxArrays& boxes, uint32_t* masks) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    BoxPlane planes[32][ViewVolume::kMostPlanes];
    for (size_t v = 0; v < volumes.size(); ++v)
        for (uint32_t k = 0; k < volumes[v].count; ++k)
            planes[v][k] = detail::boxPlane(volumes[v].planes[k], volumes[v].eye, boxes);
    for (size_t i = 0; i < boxes.count; i += hn::Lanes(d)) {
        auto seen = hn::Zero(u);
        for (size_t v = 0; v < volumes.size(); ++v) {
            if (volumes[v].empty) continue;
            M inside = hn::FirstN(d, boxes.count - i);
            for (uint32_t k = 0; k < volumes[v].count; ++k)
                inside = hn::AndNot(hn::Lt(mostOf(planes[v][k], i), hn::Zero(d)), inside);
            seen = hn::Or(seen, hn::IfThenElseZero(hn::RebindMask(u, inside), hn::Set(u, 1u << v)));
        }
        hn::StoreU(seen, u, masks + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {

HWY_EXPORT(cullRefined);
HWY_EXPORT(testVolumesKernel);

#define SIGHTLINE_FLAT_CALLS(Name, Arrays)                                                        \
    HWY_EXPORT(test##Name);                                                                       \
    HWY_EXPORT(cull##Name);                                                                       \
    void testBounds(const ViewVolume& volume, const Arrays& arrays, std::span<uint32_t> masks) {  \
        HWY_DYNAMIC_DISPATCH(test##Name)(volume, arrays, masks.data());                           \
        if (volume.empty) std::fill_n(masks.begin(), arrays.count, kOutsideMask);                 \
    }                                                                                             \
    size_t cullBounds(const ViewVolume& volume, const Arrays& arrays, std::span<uint32_t> kept) { \
        return volume.empty ? 0 : HWY_DYNAMIC_DISPATCH(cull##Name)(volume, arrays, kept.data());  \
    }
SIGHTLINE_FLAT_CALLS(Spheres, SphereArrays)
SIGHTLINE_FLAT_CALLS(Boxes, BoxArrays)
SIGHTLINE_FLAT_CALLS(OrientedBoxes, OrientedBoxArrays)
SIGHTLINE_FLAT_CALLS(Dops, DopArrays)
#undef SIGHTLINE_FLAT_CALLS

size_t cullBounds(const RefinedVolume& refined, const BoxArrays& boxes, Refinement refinement, float large,
                  std::span<uint32_t> kept) {
    const ViewVolume& volume = refined.volume;
    if (volume.empty) return 0;
    detail::RefinedPlanes planes;
    for (uint32_t k = 0; k < volume.count; ++k)
        planes.planes[planes.plane_count++] = detail::boxPlane(volume.planes[k], volume.eye, boxes);
    for (uint32_t k = 0; refinement != Refinement::kNone && k < refined.axis_count; ++k) {
        const detail::BoxPlane p = detail::boxPlane(refined.axes[k], volume.eye, boxes);
        for (int axis = 0; axis < 3; ++axis)  // the others are no more than rounding
            if (std::abs(refined.axes[k][axis]) > 0.5)
                planes.axes[planes.axis_count++] = {p.most[axis], refined.axes[k][axis] > 0.0 ? 1.0f : -1.0f,
                                                    p.plane.outer};
    }
    for (uint32_t k = 0; refinement == Refinement::kSeparatingAxes && k < refined.crossed_count; ++k)
        planes.crossed[planes.crossed_count++] = detail::boxPlane(refined.crossed[k], volume.eye, boxes);
    return HWY_DYNAMIC_DISPATCH(cullRefined)(planes, boxes, large, kept.data());
}

void testVolumes(std::span<const ViewVolume> volumes, const BoxArrays& boxes, std::span<uint32_t> masks) {
    HWY_DYNAMIC_DISPATCH(testVolumesKernel)(volumes.first(std::min<size_t>(volumes.size(), 32)), boxes, masks.data());
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
