// A walk over a hierarchy that asks all eight children of a node at once.
// SPDX-License-Identifier: MIT
#include <bit>

#include "sightline/studies/frustum/walk_planes.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/frustum/eight_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
using namespace sightline::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;
using detail::WalkPlane;

using D8 = hn::CappedTag<float, 8>;

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
                                         hn::Set(d, walk.how.large)));
        auto outside = hn::FirstN(d, 0);
        for (uint32_t k = 0; k < walk.planes.refining_count; ++k) {
            const WalkPlane& p = walk.planes.refining[k];
            outside = hn::Or(outside, hn::Lt(hn::Add(sumOf(p, p.most, node, i), hn::Set(d, p.outer)), hn::Zero(d)));
        }
        out |= bitsOf(d, hn::And(large, outside), i);
    }
    return out & candidates;
}

/// Asks the planes named; returns a bit per child that is outside, and the planes that each crosses.
uint32_t askPlanes(const detail::WalkPlanes& planes, const BvhNode& node, uint32_t active, uint32_t* crossed) {
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
        out |= bitsOf(d, outside, i);
    }
    return out;
}

/// What a volume asks, with masks or without, and with the refinement.
struct EightQuestion {
    using Visit = HierarchyScratch::Visit;

    const detail::EightWalk& walk;
    alignas(64) uint32_t crossed[8] = {};  ///< per slot: planes that were asked, and that it is not inside of

    uint32_t all() const { return (1u << walk.planes.count) - 1; }
    void begin(Visit& root) const { root.planes = all(); }
    HWY_INLINE SlotBits ask(const Visit& visit, const BvhNode& node, uint32_t used) {
        const uint32_t asked = static_cast<uint32_t>(std::popcount(used));
        ++walk.stats.nodes;
        walk.stats.boxes += asked;
        walk.stats.plane_tests += asked * static_cast<uint32_t>(std::popcount(visit.planes));
        SlotBits slots;
        slots.live = used & ~askPlanes(walk.planes, node, visit.planes, crossed);
        uint32_t crossing = 0;
        for (uint32_t slot = 0; slot < 8; ++slot) crossing |= uint32_t{crossed[slot] != 0} << slot;
        if (walk.planes.refining_count && slots.live) {
            const uint32_t separated = refine(walk, node, crossing & slots.live);
            walk.stats.refined += static_cast<uint32_t>(std::popcount(separated));
            slots.live &= ~separated;
        }
        if (walk.how.inside) slots.held = ~crossing;
        return slots;
    }
    HWY_INLINE void goBelow(const Visit&, int slot, Visit& next) const {
        next.planes = walk.how.masking ? crossed[slot] : all();
    }
    void mark(uint32_t, size_t) const {}
    void mark(int, size_t, size_t) const {}
};

size_t walkEightKernel(const detail::EightWalk& walk, const PlacedBvh& tree, Array<HierarchyScratch::Visit>& visits,
                       uint32_t* kept) {
    EightQuestion question{walk};
    HierarchyStats unused;
    return walkTree(tree, question, visits, kept, unused);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies::detail {

HWY_EXPORT(walkEightKernel);

size_t walkEight(const EightWalk& walk, const PlacedBvh& tree, Array<HierarchyScratch::Visit>& visits,
                 std::span<uint32_t> kept) {
    return HWY_DYNAMIC_DISPATCH(walkEightKernel)(walk, tree, visits, kept.data());
}

}  // namespace sightline::studies::detail
#endif  // HWY_ONCE
