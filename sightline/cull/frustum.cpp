// Keeps the boxes that may touch a view frustum: eight children of a tree node at once, or a flat list.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/cull/frustum.h"

#include <cmath>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/frustum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;
using F16 = hn::CappedTag<float, 16>;

// Each product and sum below rounds by 2^-24 of its size, each coordinate came rounded by 2^-23, each plane
// coefficient by 2^-24: ten such steps stay under 2^-19 of the sum of the sizes.
constexpr float kRounding = 0x1p-19f;

void eyeBoxesKernel(const float (&min)[3][8], const float (&max)[3][8], const glm::dvec3& offset, EyeBoxes& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    for (int axis = 0; axis < 3; ++axis) {
        const auto shift = hn::Set(d, offset[axis]);
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const auto low = hn::Add(hn::PromoteTo(d, hn::LoadU(f, min[axis] + i)), shift);
            const auto high = hn::Add(hn::PromoteTo(d, hn::LoadU(f, max[axis] + i)), shift);
            hn::StoreU(hn::DemoteTo(f, low), f, out.min[axis] + i);
            hn::StoreU(hn::DemoteTo(f, high), f, out.max[axis] + i);
        }
    }
}

void testPlanesKernel(const glm::dvec4* from, uint32_t count, const EyeBoxes& boxes, uint32_t active,
                      FrustumAnswer& answer) {
    const F8 d;
    answer.outside = 0;
    for (uint32_t& planes : answer.planes) planes = 0;
    for (uint32_t plane = 0; plane < count; ++plane) {
        if (!(active >> plane & 1)) continue;
        const glm::dvec4& p = from[plane];
        const auto distance = hn::Set(d, static_cast<float>(p.w));
        uint32_t inside = 0;
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            auto far_sum = distance, near_sum = distance, size = hn::Abs(distance);
            for (int axis = 0; axis < 3; ++axis) {
                const auto n = hn::Set(d, static_cast<float>(p[axis]));
                const auto a = hn::Mul(n, hn::Load(d, boxes.min[axis] + i));
                const auto b = hn::Mul(n, hn::Load(d, boxes.max[axis] + i));
                far_sum = hn::Add(far_sum, hn::Max(a, b));  // the corner farthest inside
                near_sum = hn::Add(near_sum, hn::Min(a, b));
                size = hn::Add(size, hn::Max(hn::Abs(a), hn::Abs(b)));
            }
            const auto margin = hn::Mul(size, hn::Set(d, kRounding));
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Lt(far_sum, hn::Neg(margin)), bits);
            answer.outside |= uint32_t{bits[0]} << i;
            hn::StoreMaskBits(d, hn::Ge(near_sum, margin), bits);
            inside |= uint32_t{bits[0]} << i;
        }
        for (int box = 0; box < 8; ++box)
            if (!(inside >> box & 1)) answer.planes[box] |= 1u << plane;
    }
}

uint32_t outsideAnyKernel(const glm::dvec4* planes, size_t count, const EyeBoxes& boxes) {
    const F8 d;
    uint32_t outside = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto any = hn::FirstN(d, 0);
        for (size_t plane = 0; plane < count; ++plane) {
            const glm::dvec4& p = planes[plane];
            auto sum = hn::Set(d, static_cast<float>(p.w)), size = hn::Abs(sum);
            for (int axis = 0; axis < 3; ++axis) {
                const auto n = hn::Set(d, static_cast<float>(p[axis]));
                const auto a = hn::Mul(n, hn::Load(d, boxes.min[axis] + i));
                const auto b = hn::Mul(n, hn::Load(d, boxes.max[axis] + i));
                sum = hn::Add(sum, hn::Max(a, b));
                size = hn::Add(size, hn::Max(hn::Abs(a), hn::Abs(b)));
            }
            any = hn::Or(any, hn::Lt(sum, hn::Neg(hn::Mul(size, hn::Set(d, kRounding)))));
        }
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, any, bits);
        outside |= uint32_t{bits[0]} << i;
    }
    return outside;
}

size_t cullFrustumKernel(const Frustum& frustum, const BoxArrays& boxes, uint32_t* kept) {
    const F16 d;
    const hn::RebindToUnsigned<F16> u;
    const size_t lanes = hn::Lanes(d);
    const float* corner[6][3];
    float plane[6][4];
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec4& p = frustum.planes[i];
        const glm::dvec3 shift = boxes.origin - frustum.eye;
        double size = std::abs(p.w) + std::abs(glm::dot(glm::dvec3(p), shift));
        for (int axis = 0; axis < 3; ++axis) {
            corner[i][axis] = p[axis] >= 0 ? boxes.max[axis] : boxes.min[axis];
            plane[i][axis] = static_cast<float>(p[axis]);
            size += std::abs(p[axis]) * boxes.reach;
        }
        plane[i][3] = static_cast<float>(p.w + glm::dot(glm::dvec3(p), shift) + kRounding * size);
    }
    size_t count = 0;
    for (size_t i = 0; i < boxes.count; i += lanes) {
        auto inside = hn::FirstN(d, boxes.count - i);
        for (uint32_t k = 0; k < frustum.count; ++k) {
            const auto x = hn::Mul(hn::Set(d, plane[k][0]), hn::LoadU(d, corner[k][0] + i));
            const auto y = hn::Mul(hn::Set(d, plane[k][1]), hn::LoadU(d, corner[k][1] + i));
            const auto z = hn::Mul(hn::Set(d, plane[k][2]), hn::LoadU(d, corner[k][2] + i));
            const auto s = hn::Add(hn::Add(x, y), hn::Add(z, hn::Set(d, plane[k][3])));
            inside = hn::And(inside, hn::Not(hn::Lt(s, hn::Zero(d))));
        }
        const auto index = hn::Iota(u, static_cast<uint32_t>(i));
        // In two steps: processors that have one instruction for both are slow at it.
        hn::StoreU(hn::Compress(index, hn::RebindMask(u, inside)), u, kept + count);
        count += hn::CountTrue(d, inside);
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(eyeBoxesKernel);
HWY_EXPORT(testPlanesKernel);
HWY_EXPORT(outsideAnyKernel);
HWY_EXPORT(cullFrustumKernel);

EyeBoxes eyeBoxes(const float (&min)[3][8], const float (&max)[3][8], const glm::dvec3& offset) {
    EyeBoxes out;
    HWY_DYNAMIC_DISPATCH(eyeBoxesKernel)(min, max, offset, out);
    return out;
}

EyeBoxes eyeBoxes(const BvhNode& node, const glm::dvec3& offset) { return eyeBoxes(node.min, node.max, offset); }

FrustumAnswer testFrustum(const Frustum& frustum, const EyeBoxes& boxes, uint32_t active) {
    SIGHTLINE_DEBUG_ASSERT(frustum.count <= std::size(frustum.planes));
    FrustumAnswer answer;
    HWY_DYNAMIC_DISPATCH(testPlanesKernel)(frustum.planes, frustum.count, boxes, active, answer);
    return answer;
}

FrustumAnswer testViewVolume(const ViewVolume& volume, const EyeBoxes& boxes, uint32_t active) {
    SIGHTLINE_DEBUG_ASSERT(volume.count <= ViewVolume::kMostPlanes);
    FrustumAnswer answer;
    HWY_DYNAMIC_DISPATCH(testPlanesKernel)(volume.planes, volume.count, boxes, active, answer);
    return answer;
}

uint32_t outsideAny(std::span<const glm::dvec4> planes, const EyeBoxes& boxes) {
    return HWY_DYNAMIC_DISPATCH(outsideAnyKernel)(planes.data(), planes.size(), boxes);
}

size_t cullFrustum(const Frustum& frustum, const BoxArrays& boxes, std::span<uint32_t> kept) {
    SIGHTLINE_DEBUG_ASSERT(frustum.count <= std::size(frustum.planes));
    SIGHTLINE_DEBUG_ASSERT(kept.size() >= (boxes.count + 15) / 16 * 16);
    return HWY_DYNAMIC_DISPATCH(cullFrustumKernel)(frustum, boxes, kept.data());
}

}  // namespace sightline
#endif  // HWY_ONCE
