// The items whose boxes overlap a box: what a light reaches, what a blast hits, what a region of a map holds.
// SPDX-License-Identifier: MIT
//
// Antonin Guttman. R-Trees: A Dynamic Index Structure for Spatial Searching. 1984.
#include "sightline/cull/box_query.h"

#include <algorithm>
#include <bit>

#include "sightline/base/assert.h"
#include "sightline/space/bvh_node.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/box_query.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef SIGHTLINE_CULL_BOX_QUERY_ONCE
#define SIGHTLINE_CULL_BOX_QUERY_ONCE
namespace sightline::detail {

/// A tree whose items stand in order, so that all below a node are one range of it.
struct OrderedTree {
    const Bvh& bvh;
    uint32_t root = 0;

    const BvhNode& node(uint32_t index) const { return bvh.nodes[index]; }
};

/// A tree whose slots name the items themselves.
struct LinkedTree {
    const LivingBvh& bvh;
    uint32_t root = bvh.root;

    const BvhNode& node(uint32_t index) const { return bvh.node(index); }
};

/// What HierarchyScratch::Visit::planes says here.
inline constexpr uint32_t kHeld = 0, kCrossed = 1;

}  // namespace sightline::detail
#endif  // SIGHTLINE_CULL_BOX_QUERY_ONCE

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using detail::kCrossed;
using detail::kHeld;
using detail::LinkedTree;
using detail::OrderedTree;

using D8 = hn::CappedTag<float, 8>;
using U8 = hn::RebindToUnsigned<D8>;
using D16 = hn::CappedTag<float, 16>;

/// Lanes of boxes that overlap the box; what is not a number separates nothing.
template <class D, class Load>
HWY_INLINE hn::Mask<D> overlaps(D d, const Box3f& box, const Load& load) {
    auto apart = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
        apart = hn::Or(apart, hn::Gt(load(0, axis), hn::Set(d, box.max[axis])));
        apart = hn::Or(apart, hn::Lt(load(1, axis), hn::Set(d, box.min[axis])));
    }
    return hn::Not(apart);
}

/// Lanes of boxes that lie within the box.
template <class D, class Load>
HWY_INLINE hn::Mask<D> within(D d, const Box3f& box, const Load& load) {
    auto beyond = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
        beyond = hn::Or(beyond, hn::Not(hn::Ge(load(0, axis), hn::Set(d, box.min[axis]))));
        beyond = hn::Or(beyond, hn::Not(hn::Le(load(1, axis), hn::Set(d, box.max[axis]))));
    }
    return hn::Not(beyond);
}

template <class D>
HWY_INLINE uint32_t bitsOf(D d, hn::Mask<D> mask, size_t first) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return uint32_t{bits[0]} << first;
}

HWY_INLINE hn::Vec<U8> itemsOf(const OrderedTree& tree, hn::Vec<U8> place) {
    const U8 u;
    const hn::RebindToSigned<U8> index;
    return hn::GatherIndex(u, tree.bvh.order.data(), hn::BitCast(index, place));
}
HWY_INLINE hn::Vec<U8> itemsOf(const LinkedTree&, hn::Vec<U8> item) { return item; }

/// What of a node's slots is of use.
struct Slots {
    uint32_t nodes = 0;  ///< a bit per slot that holds a node and overlaps the box
    uint32_t held = 0;   ///< a bit per slot that lies within the box
};

/// Writes the items among a node's slots that overlap the box (all, if the node is held), and returns how many.
template <class Tree>
HWY_INLINE size_t takeSlots(const Box3f& box, const Tree& tree, const BvhNode& node, bool held, uint32_t* kept,
                            Slots& slots) {
    const D8 d;
    const U8 u;
    size_t count = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const auto load = [&](int side, int axis)
                              HWY_ATTR { return hn::Load(d, (side ? node.max : node.min)[axis] + i); };
        const auto child = hn::Load(u, node.child + i);
        const auto is_item = hn::Ne(hn::And(child, hn::Set(u, BvhNode::kLeaf)), hn::Zero(u));
        auto taken = hn::Ne(child, hn::Set(u, kUnusedChild));
        if (!held) {
            taken = hn::And(taken, hn::RebindMask(u, overlaps(d, box, load)));
            slots.held |= bitsOf(d, within(d, box, load), i);
        }
        slots.nodes |= bitsOf(u, hn::AndNot(is_item, taken), i);
        const auto items = hn::And(taken, is_item);
        if (hn::AllFalse(u, items)) continue;
        const auto place = hn::IfThenElseZero(items, hn::And(child, hn::Set(u, ~BvhNode::kLeaf)));
        count += hn::CompressStore(itemsOf(tree, place), items, u, kept + count);
    }
    return count;
}

HWY_INLINE void prefetch(const BvhNode& node) {
    const char* at = reinterpret_cast<const char*>(&node);
    for (size_t line = 0; line < 256; line += 64) hwy::Prefetch(at + line);
}

/// All items below a slot that lies within the box: copied, or left for later.
HWY_INLINE size_t takeBelow(const OrderedTree& tree, const BvhNode& node, int slot, Array<HierarchyScratch::Visit>&,
                            uint32_t* kept) {
    const U8 u;
    const uint32_t* order = tree.bvh.order.data() + node.first[slot];
    const size_t count = node.count[slot];
    size_t i = 0;
    for (; i + hn::Lanes(u) <= count; i += hn::Lanes(u)) hn::StoreU(hn::LoadU(u, order + i), u, kept + i);
    for (; i < count; ++i) kept[i] = order[i];
    return count;
}
HWY_INLINE size_t takeBelow(const LinkedTree&, const BvhNode& node, int slot, Array<HierarchyScratch::Visit>& visits,
                            uint32_t*) {
    visits.push_back({node.child[slot], kHeld});
    return 0;
}

/// Leaves for later the items below a slot that crosses the box.
HWY_INLINE void goBelow(const OrderedTree& tree, const BvhNode& node, int slot,
                        Array<HierarchyScratch::Visit>& visits) {
    hwy::Prefetch(tree.bvh.order.data() + node.first[slot]);
    visits.push_back({node.child[slot], kCrossed});
}
HWY_INLINE void goBelow(const LinkedTree&, const BvhNode& node, int slot, Array<HierarchyScratch::Visit>& visits) {
    visits.push_back({node.child[slot], kCrossed});
}

/// Level by level, so that what comes next is known early enough to be fetched.
template <class Tree>
HWY_INLINE size_t walk(const Box3f& box, const Tree& tree, Array<HierarchyScratch::Visit>& visits, uint32_t* kept,
                       HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    visits.assign(1, {tree.root, kCrossed});
    size_t count = 0, fetched = 0;
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched) prefetch(tree.node(visits[fetched].node));
        const HierarchyScratch::Visit visit = visits[at];
        const BvhNode& node = tree.node(visit.node);
        const bool held = visit.planes == kHeld;
        ++(held ? stats.inside_nodes : stats.nodes);
        Slots slots;
        if (held) slots.held = 0xff;
        count += takeSlots(box, tree, node, held, kept + count, slots);
        for (; slots.nodes; slots.nodes &= slots.nodes - 1) {
            const int slot = std::countr_zero(slots.nodes);
            if (slots.held >> slot & 1) count += takeBelow(tree, node, slot, visits, kept + count);
            else goBelow(tree, node, slot, visits);
        }
    }
    return count;
}

size_t walkOrdered(const Box3f& box, const Bvh& tree, Array<HierarchyScratch::Visit>& visits, uint32_t* kept,
                   HierarchyStats& stats) {
    return walk(box, OrderedTree{tree}, visits, kept, stats);
}

size_t walkLinked(const Box3f& box, const LivingBvh& tree, Array<HierarchyScratch::Visit>& visits, uint32_t* kept,
                  HierarchyStats& stats) {
    return walk(box, LinkedTree{tree}, visits, kept, stats);
}

size_t takeFlat(const Box3f& box, const BoxArrays& boxes, uint32_t* kept) {
    const D16 d;
    const hn::RebindToUnsigned<D16> u;
    size_t count = 0;
    for (size_t i = 0; i < boxes.count; i += hn::Lanes(d)) {
        const auto load = [&](int side, int axis)
                              HWY_ATTR { return hn::LoadU(d, (side ? boxes.max : boxes.min)[axis] + i); };
        const auto taken = hn::And(hn::FirstN(d, boxes.count - i), overlaps(d, box, load));
        const auto index = hn::Iota(u, static_cast<uint32_t>(i));
        count += hn::CompressStore(index, hn::RebindMask(u, taken), u, kept + count);
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

HWY_EXPORT(walkOrdered);
HWY_EXPORT(walkLinked);
HWY_EXPORT(takeFlat);

bool isEmpty(const Box3d& box) {
    return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;  // what is NaN is not
}

}  // namespace

size_t queryBox(const Box3d& box, const Bvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= tree.order.size() + 8);
    HierarchyStats done;
    size_t count = 0;
    if (!tree.nodes.empty() && !isEmpty(box))
        count =
            HWY_DYNAMIC_DISPATCH(walkOrdered)(roundOutward(box, tree.origin), tree, scratch.visits, kept.data(), done);
    if (stats) *stats = done;
    return count;
}

size_t queryBox(const Box3d& box, const LivingBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.count} + 8);
    HierarchyStats done;
    size_t count = 0;
    for (const uint32_t item : tree.unbounded) kept[count++] = item;
    if (tree.root != LivingBvh::kNone && !isEmpty(box))
        count += HWY_DYNAMIC_DISPATCH(walkLinked)(roundOutward(box, tree.origin), tree, scratch.visits,
                                                  kept.data() + count, done);
    if (stats) *stats = done;
    return count;
}

size_t queryBox(const Box3d& box, const BoxArrays& boxes, std::span<uint32_t> kept) {
    if (isEmpty(box)) return 0;
    return HWY_DYNAMIC_DISPATCH(takeFlat)(roundOutward(box, boxes.origin), boxes, kept.data());
}

}  // namespace sightline
#endif  // HWY_ONCE
