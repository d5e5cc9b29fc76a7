// Hides boxes in the shadow volumes of a few large convex occluders, in object space: no pixels.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occluder_volumes.h"

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/occluder_volumes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;

void testVolumeKernel(const OccluderVolume& volume, const EyeBoxes& boxes, uint32_t active, uint32_t wanted,
                      VolumeAnswer& answer) {
    const F8 d;
    alignas(64) float reach[8];  // no point of a box is farther from the eye
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto sum = hn::Zero(d);
        for (int axis = 0; axis < 3; ++axis) {
            const auto low = hn::Load(d, boxes.min[axis] + i), high = hn::Load(d, boxes.max[axis] + i);
            sum = hn::Add(sum, hn::Max(hn::Abs(low), hn::Abs(high)));
            // Max may lose a NaN; this keeps it, and makes one of what is infinite: no plane has such a box above.
            sum = hn::Add(sum, hn::Mul(hn::Zero(d), hn::Add(low, high)));
        }
        hn::Store(sum, d, reach + i);
    }
    // Boxes that nobody asks for are done with from the start: the sooner all are, the fewer planes are asked.
    uint32_t outside = ~wanted & 0xff, above_all = 0xff, asked = 0;
    uint8_t above_of[OccluderVolume::kMaxPlanes], plane_of[OccluderVolume::kMaxPlanes];
    for (uint32_t left = active & volume.allPlanes(); left && outside != 0xff; left &= left - 1) {
        const uint32_t plane = static_cast<uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
        uint32_t above = 0;
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            auto highest = hn::Set(d, volume.distance[plane]), lowest = highest;
            for (int axis = 0; axis < 3; ++axis) {
                const auto n = hn::Set(d, volume.normal[plane][axis]);
                const auto a = hn::Mul(n, hn::Load(d, boxes.min[axis] + i));
                const auto b = hn::Mul(n, hn::Load(d, boxes.max[axis] + i));
                highest = hn::Add(highest, hn::Max(a, b));
                lowest = hn::Add(lowest, hn::Min(a, b));
            }
            const auto slack = hn::Add(hn::Set(d, volume.slack[plane][0]),
                                       hn::Mul(hn::Set(d, volume.slack[plane][1]), hn::Load(d, reach + i)));
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Gt(lowest, slack), bits);
            above |= uint32_t{bits[0]} << i;
            hn::StoreMaskBits(d, hn::Gt(highest, hn::Zero(d)), bits);
            outside |= (~uint32_t{bits[0]} & ((1u << hn::Lanes(d)) - 1)) << i;
        }
        above_of[asked] = static_cast<uint8_t>(above);
        plane_of[asked++] = static_cast<uint8_t>(plane);
        above_all &= above;
    }
    answer.outside = outside & wanted;
    answer.hidden = above_all & ~outside;
    for (uint32_t left = ~(outside | above_all) & 0xff; left; left &= left - 1) {
        const uint32_t box = static_cast<uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
        uint32_t planes = 0;
        for (uint32_t i = 0; i < asked; ++i) planes |= (~uint32_t{above_of[i]} >> box & 1) << plane_of[i];
        answer.planes[box] = planes;
    }
}

void shadowSharesKernel(const OccluderVolume& volume, const EyeBoxes& boxes, float* share) {
    const F8 d;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto product = hn::Set(d, 1.0f);
        for (uint32_t plane = 0; plane < volume.planes; ++plane) {
            auto highest = hn::Set(d, volume.distance[plane]), lowest = highest;
            for (int axis = 0; axis < 3; ++axis) {
                const auto n = hn::Set(d, volume.normal[plane][axis]);
                const auto a = hn::Mul(n, hn::Load(d, boxes.min[axis] + i));
                const auto b = hn::Mul(n, hn::Load(d, boxes.max[axis] + i));
                highest = hn::Add(highest, hn::Max(a, b));
                lowest = hn::Add(lowest, hn::Min(a, b));
            }
            const auto tiny = hn::Set(d, 1e-30f);
            const auto part = hn::Div(highest, hn::Max(hn::Sub(highest, lowest), tiny));
            product = hn::Mul(product, hn::Min(hn::Max(part, hn::Zero(d)), hn::Set(d, 1.0f)));
        }
        hn::Store(product, d, share + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(testVolumeKernel);
HWY_EXPORT(shadowSharesKernel);

VolumeAnswer testVolume(const OccluderVolume& volume, const EyeBoxes& boxes, uint32_t active, uint32_t wanted) {
    SIGHTLINE_DEBUG_ASSERT(volume.planes <= OccluderVolume::kMaxPlanes && wanted <= 0xff);
    VolumeAnswer answer;
    HWY_DYNAMIC_DISPATCH(testVolumeKernel)(volume, boxes, active, wanted, answer);
    return answer;
}

void shadowShares(const OccluderVolume& volume, const EyeBoxes& boxes, float* share) {
    SIGHTLINE_DEBUG_ASSERT(volume.planes <= OccluderVolume::kMaxPlanes);
    SIGHTLINE_DEBUG_ASSERT(reinterpret_cast<uintptr_t>(share) % 64 == 0);
    HWY_DYNAMIC_DISPATCH(shadowSharesKernel)(volume, boxes, share);
}

}  // namespace sightline
#endif  // HWY_ONCE
