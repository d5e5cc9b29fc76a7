// A walk over a hierarchy that asks all eight children of a node at once.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "sightline/cull/walk_planes.h"
#include "sightline/space/bvh_node.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/eight_walk.cpp"
#include <hwy/cache_control.h>
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

/// Bits of the children that are in use; `items` becomes those that are items.
uint32_t usedSlots(const BvhNode& node, uint32_t& items) {
    const U8 u;
    uint32_t used = 0;
    items = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
        const auto child = hn::Load(u, node.child + i);
        const auto in_use = hn::Ne(child, hn::Set(u, kUnusedChild));
        const auto is_item = hn::Ne(hn::And(child, hn::Set(u, BvhNode::kLeaf)), hn::Zero(u));
        uint8_t bits[8] = {};
        hn::StoreMaskBits(u, in_use, bits);
        used |= uint32_t{bits[0]} << i;
        hn::StoreMaskBits(u, hn::And(in_use, is_item), bits);
        items |= uint32_t{bits[0]} << i;
    }
    return used;
}

/// Writes the items in the slots named, and returns how many.
/// @param room  where nothing more may be written than items
size_t takeItems(const Bvh& bvh, const BvhNode& node, uint32_t slots, std::span<uint32_t> room) {
    const U8 u;
    const hn::RebindToSigned<U8> index;
    size_t count = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
        uint8_t bits[8] = {static_cast<uint8_t>(slots >> i)};
        const auto taken = hn::LoadMaskBits(u, bits);
        const auto place = hn::IfThenElseZero(taken, hn::Load(u, node.first + i));
        const auto items = hn::GatherIndex(u, bvh.order.data(), hn::BitCast(index, place));
        if (count + hn::Lanes(u) <= room.size())
            count += hn::CompressStore(items, taken, u, room.data() + count);  // may write more, which is faster
        else count += hn::CompressBlendedStore(items, taken, u, room.data() + count);
    }
    return count;
}

/// Copies all items below a child.
size_t takeBelow(const Bvh& bvh, const BvhNode& node, uint32_t slot, uint32_t* kept) {
    const U8 u;
    const uint32_t* order = bvh.order.data() + node.first[slot];
    const size_t count = node.count[slot];
    size_t i = 0;
    for (; i + hn::Lanes(u) <= count; i += hn::Lanes(u)) hn::StoreU(hn::LoadU(u, order + i), u, kept + i);
    for (; i < count; ++i) kept[i] = order[i];
    return count;
}

void prefetch(const BvhNode& node) {
    const char* at = reinterpret_cast<const char*>(&node);
    for (size_t line = 0; line < sizeof(BvhNode); line += 64) hwy::Prefetch(at + line);
}

/// Level by level, so that what comes next is known early enough to be fetched.
size_t walkEightKernel(detail::EightWalk& walk, Array<detail::WalkVisit>& visits) {
    constexpr size_t kAhead = 8;
    const Bvh& bvh = walk.bvh;
    const uint32_t all = (1u << walk.planes.count) - 1;
    size_t found = 0, fetched = 0;
    alignas(64) uint32_t crossed[8];
    visits.clear();
    visits.push_back({0, all});
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched) prefetch(bvh.nodes[visits[fetched].node]);
        const detail::WalkVisit visit = visits[at];
        const BvhNode& node = bvh.nodes[visit.node];
        uint32_t items;
        uint32_t live = usedSlots(node, items);
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
        if (live & items) found += takeItems(bvh, node, live & items, walk.kept.subspan(found));
        for (live &= ~items; live; live &= live - 1) {
            const uint32_t slot = static_cast<uint32_t>(std::countr_zero(live));
            if (walk.inside && crossed[slot] == 0) {
                found += takeBelow(bvh, node, slot, walk.kept.data() + found);
            } else {
                hwy::Prefetch(bvh.order.data() + node.first[slot]);
                visits.push_back({node.child[slot], walk.masking ? crossed[slot] : all});
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

size_t walkEight(EightWalk& walk, Array<WalkVisit>& visits) {
    return HWY_DYNAMIC_DISPATCH(walkEightKernel)(walk, visits);
}

}  // namespace sightline::detail
#endif  // HWY_ONCE
