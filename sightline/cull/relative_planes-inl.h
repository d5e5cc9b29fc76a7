// Eight boxes against the planes of a frustum, for every hierarchy that keeps its boxes so; once per instruction set.
// SPDX-License-Identifier: MIT
#include "sightline/cull/relative_planes.h"

#if defined(SIGHTLINE_CULL_RELATIVE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULL_RELATIVE_PLANES_INL_H_
#undef SIGHTLINE_CULL_RELATIVE_PLANES_INL_H_
#else
#define SIGHTLINE_CULL_RELATIVE_PLANES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes8 = hn::CappedTag<float, 8>;

struct SlotAnswer {
    uint32_t outside = 0;  ///< bit per slot
    uint32_t inside[6];    ///< per plane: bit per slot
};

/// Eight boxes as min[3][8] and max[3][8], aligned. The arithmetic is that of cullFrustum(), in its order.
template <class Boxes>
HWY_INLINE SlotAnswer testSlots(const RelativePlanes& planes, const Boxes& boxes, uint32_t active) {
    const Lanes8 d;
    SlotAnswer slots;
    for (uint32_t plane = 0; plane < planes.count; ++plane) {
        slots.inside[plane] = 0xff;
        if (!(active >> plane & 1)) continue;
        const float* normal = planes.normal[plane];
        const float* far_corner[3];
        const float* near_corner[3];
        for (int axis = 0; axis < 3; ++axis) {
            far_corner[axis] = normal[axis] >= 0 ? boxes.max[axis] : boxes.min[axis];
            near_corner[axis] = normal[axis] >= 0 ? boxes.min[axis] : boxes.max[axis];
        }
        const auto nx = hn::Set(d, normal[0]), ny = hn::Set(d, normal[1]), nz = hn::Set(d, normal[2]);
        const auto distance = hn::Set(d, planes.distance[plane]);
        uint32_t inside = 0;
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const auto at = [&](const float* const(&corner)[3]) HWY_ATTR {
                const auto x = hn::Mul(nx, hn::Load(d, corner[0] + i));
                const auto y = hn::Mul(ny, hn::Load(d, corner[1] + i));
                const auto z = hn::Mul(nz, hn::Load(d, corner[2] + i));
                return hn::Add(hn::Add(x, y), hn::Add(z, distance));
            };
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Lt(at(far_corner), hn::Zero(d)), bits);
            slots.outside |= uint32_t{bits[0]} << i;
            hn::StoreMaskBits(d, hn::Ge(at(near_corner), hn::Zero(d)), bits);
            inside |= uint32_t{bits[0]} << i;
        }
        slots.inside[plane] = inside;
    }
    return slots;
}

/// The planes that the box in a slot is not inside of.
HWY_INLINE uint32_t planesLeft(const RelativePlanes& planes, const SlotAnswer& answer, int slot) {
    uint32_t left = 0;
    for (uint32_t plane = 0; plane < planes.count; ++plane) left |= (~answer.inside[plane] >> slot & 1) << plane;
    return left;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // toggle
