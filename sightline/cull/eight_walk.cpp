// A walk over a hierarchy that asks all eight children of a node at once.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cstring>

#include "sightline/cull/walk_planes.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/eight_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using detail::WalkPlane;

using D8 = hn::CappedTag<float, 8>;
using U8 = hn::RebindToUnsigned<D8>;

hn::Vec<D8> sumOf(const WalkPlane& p, const uint8_t* rows, const BvhNode& node, size_t i) {
    const D8 d;
    const auto term = [&](int axis) {
        return hn::Mul(hn::Set(d, p.n[axis]), hn::Load(d, detail::rowOf(node, rows[axis]) + i));
    };
    return hn::Add(hn::Add(term(0), term(1)), term(2));
}

/// Bits of the children that are in use, large and not separated from the volume.
uint32_t refine(const detail::EightWalk& walk, const BvhNode& node, uint32_t candidates) {
    const D8 d;
    uint32_t out = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto large = hn::FirstN(d, 0);
        for (int axis = 0; axis < 3; ++axis)
            large = hn::Or(large, hn::Ge(hn::Sub(hn::Load(d, node.max[axis] + i), hn::Load(d, node.min[axis] + i)),
                                         hn::Set(d, walk.large)));
        auto outside = hn::FirstN(d, 0);
        for (uint32_t k = 0; k < walk.planes.refining_count; ++k) {
            const WalkPlane& p = walk.planes.refining[k];
            outside = hn::Or(outside, hn::Lt(hn::Add(sumOf(p, p.most, node, i), hn::Set(d, p.outer)), hn::Zero(d)));
        }
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::And(large, outside), bits);
        out |= uint32_t{bits[0]} << i;
    }
    return out & candidates;
}

/// Asks the planes named; returns a bit per child that is outside, and the planes that each crosses.
uint32_t ask(const detail::WalkPlanes& planes, const BvhNode& node, uint32_t active, uint32_t* crossed) {
    const D8 d;
    const U8 u;
    uint32_t out = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto crossing = hn::Zero(u);
        auto outside = hn::FirstN(d, 0);
        for (uint32_t left = active; left; left &= left - 1) {
            const uint32_t k = static_cast<uint32_t>(std::countr_zero(left));
            const WalkPlane& p = planes.planes[k];
            outside = hn::Or(outside, hn::Lt(hn::Add(sumOf(p, p.most, node, i), hn::Set(d, p.outer)), hn::Zero(d)));
            const auto inside = hn::Ge(hn::Add(sumOf(p, p.least, node, i), hn::Set(d, p.inner)), hn::Zero(d));
            crossing = hn::Or(crossing, hn::IfThenZeroElse(hn::RebindMask(u, inside), hn::Set(u, 1u << k)));
        }
        hn::Store(crossing, u, crossed + i);
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, outside, bits);
        out |= uint32_t{bits[0]} << i;
    }
    return out;
}

size_t walkEightKernel(detail::EightWalk& walk, Array<detail::WalkVisit>& stack) {
    const Bvh& bvh = walk.bvh;
    const uint32_t all = (1u << walk.planes.count) - 1;
    size_t found = 0;
    alignas(64) uint32_t crossed[8];
    stack.clear();
    stack.push_back({0, all});
    while (!stack.empty()) {
        const detail::WalkVisit visit = stack.back();
        stack.pop_back();
        const BvhNode& node = bvh.nodes[visit.node];
        uint32_t live = 0;
        for (uint32_t slot = 0; slot < 8; ++slot) live |= uint32_t{node.count[slot] != 0} << slot;
        const uint32_t asked = static_cast<uint32_t>(std::popcount(live));
        ++walk.nodes;
        walk.boxes += asked;
        walk.plane_tests += asked * static_cast<uint32_t>(std::popcount(visit.planes));
        live &= ~ask(walk.planes, node, visit.planes, crossed);
        if (walk.planes.refining_count && live) {
            uint32_t candidates = 0;
            for (uint32_t slot = 0; slot < 8; ++slot) candidates |= uint32_t{crossed[slot] != 0} << slot;
            const uint32_t separated = refine(walk, node, candidates & live);
            walk.refined += static_cast<uint32_t>(std::popcount(separated));
            live &= ~separated;
        }
        for (; live; live &= live - 1) {
            const uint32_t slot = static_cast<uint32_t>(std::countr_zero(live));
            if (node.child[slot] & BvhNode::kLeaf) {
                walk.kept[found++] = bvh.order[node.first[slot]];
            } else if (walk.inside && crossed[slot] == 0) {
                std::memcpy(walk.kept + found, bvh.order.data() + node.first[slot],
                            node.count[slot] * sizeof(uint32_t));
                found += node.count[slot];
            } else {
                stack.push_back({node.child[slot], walk.masking ? crossed[slot] : all});
            }
        }
    }
    return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::detail {

HWY_EXPORT(walkEightKernel);

size_t walkEight(EightWalk& walk, Array<WalkVisit>& stack) {
    return HWY_DYNAMIC_DISPATCH(walkEightKernel)(walk, stack);
}

}  // namespace sightline::detail
#endif  // HWY_ONCE
