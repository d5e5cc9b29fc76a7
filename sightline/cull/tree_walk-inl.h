// The way down a world's hierarchy, whatever is asked of its nodes: items taken, ranges copied; once per instruction set.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "sightline/base/assert.h"
#include "sightline/cull/hierarchy_scratch.h"
#include "sightline/tree/bvh_node.h"
#include "sightline/tree/world_bvh.h"

#if defined(SIGHTLINE_CULL_TREE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULL_TREE_WALK_INL_H_
#undef SIGHTLINE_CULL_TREE_WALK_INL_H_
#else
#define SIGHTLINE_CULL_TREE_WALK_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using U8 = hn::CappedTag<uint32_t, 8>;

/// A bit per slot.
struct SlotKinds {
    uint32_t items = 0, nodes = 0;
};

/// What is asked of the slots of a node, answered; a bit per slot.
struct SlotBits {
    uint32_t live = 0;  ///< something below may be wanted; of unused slots it means nothing
    uint32_t held = 0;  ///< of these: all below is wanted
};

template <class D>
HWY_INLINE uint32_t bitsOf(D d, hn::Mask<D> mask, size_t first) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return uint32_t{bits[0]} << first;
}

HWY_INLINE hn::Mask<U8> lanesOf(uint32_t slots, size_t first) {
    const uint8_t bits[8] = {static_cast<uint8_t>(slots >> first)};
    return hn::LoadMaskBits(U8(), bits);
}

HWY_INLINE SlotKinds kindsOf(const BvhNode& node) {
    const U8 u;
    SlotKinds used;
    for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
        const auto child = hn::Load(u, node.child + i);
        const auto in_use = hn::Ne(child, hn::Set(u, kUnusedChild));
        const auto is_item = hn::Ne(hn::And(child, hn::Set(u, BvhNode::kLeaf)), hn::Zero(u));
        used.items |= bitsOf(u, hn::And(in_use, is_item), i);
        used.nodes |= bitsOf(u, hn::AndNot(is_item, in_use), i);
    }
    return used;
}

/// Writes the items in the slots named, and returns how many.
/// @param kept     [size: >= those items + 8]
/// @param item_of  lanes of items for lanes of BvhNode::child without kLeaf
template <class ItemOf>
HWY_INLINE size_t takeItems(const BvhNode& node, uint32_t slots, uint32_t* kept, const ItemOf& item_of) {
    const U8 u;
    size_t count = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
        const auto taken = lanesOf(slots, i);
        const auto child = hn::And(hn::Load(u, node.child + i), hn::Set(u, ~BvhNode::kLeaf));
        count += hn::CompressStore(item_of(hn::IfThenElseZero(taken, child)), taken, u, kept + count);
    }
    return count;
}

/// The same where slots name places of the tree's order.
/// @param slots  at least one
HWY_INLINE size_t takePlaced(const PlacedBvh& tree, const BvhNode& node, uint32_t slots, uint32_t* kept) {
    constexpr uint32_t kPage = PlacedBvh::kOrderPage;
    static_assert((kPage & (kPage - 1)) == 0);
    SIGHTLINE_DEBUG_ASSERT(slots != 0 && slots <= 0xff);
    const U8 u;
    const uint32_t page = node.first[std::countr_zero(slots)] / kPage;
    uint32_t elsewhere = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
        const auto place = hn::Load(u, node.first + i);
        elsewhere |= bitsOf(u, hn::Ne(hn::And(place, hn::Set(u, ~(kPage - 1))), hn::Set(u, page * kPage)), i);
    }
    if (elsewhere & slots) {
        size_t count = 0;
        for (; slots != 0; slots &= slots - 1) kept[count++] = tree.order[node.first[std::countr_zero(slots)]];
        return count;
    }
    const uint32_t* order = &tree.order[size_t{page} * kPage];
    return takeItems(node, slots, kept, [&](hn::Vec<U8> place) HWY_ATTR {
        const hn::RebindToSigned<U8> index;
        return hn::GatherIndex(u, order, hn::BitCast(index, hn::And(place, hn::Set(u, kPage - 1))));
    });
}

/// Copies all items below a slot, and returns how many. Places that are empty are left out.
/// @param kept  [size: >= those items + 8]
HWY_INLINE size_t takeBelow(const PlacedBvh& tree, const BvhNode& node, int slot, uint32_t* kept) {
    const U8 u;
    size_t count = 0;
    uint32_t place = node.first[slot];
    SIGHTLINE_DEBUG_ASSERT(place + node.count[slot] <= tree.order.size() && node.empty[slot] <= node.count[slot]);
    const uint32_t end = place + node.count[slot];
    while (place < end) {
        const std::span<const uint32_t> run = tree.order.run(place, end - place);
        place += static_cast<uint32_t>(run.size());
        if (node.empty[slot] == 0) {
            std::copy(run.begin(), run.end(), kept + count);
            count += run.size();
            continue;
        }
        size_t i = 0;
        for (; i + hn::Lanes(u) <= run.size(); i += hn::Lanes(u)) {
            const auto items = hn::LoadU(u, run.data() + i);
            count += hn::CompressStore(items, hn::Ne(items, hn::Set(u, PlacedBvh::kNone)), u, kept + count);
        }
        for (; i < run.size(); ++i)
            if (run[i] != PlacedBvh::kNone) kept[count++] = run[i];
    }
    return count;
}

HWY_INLINE void prefetch(const BvhNode& node) {
    const char* at = reinterpret_cast<const char*>(&node);
    for (size_t line = 0; line < sizeof(BvhNode); line += 64) hwy::Prefetch(at + line);
}

/// Level by level, so that what comes next is known early enough to be fetched.
///
/// A question has: begin(visit) of the root; ask(visit, node, used slots), which returns SlotBits; goBelow(visit, slot,
/// next), which fills what it wants to know at the child; and of items that are kept, mark(slots, at) and
/// mark(slot, at, count), told before they are written.
/// @param kept  [size: >= tree.size() + 8]
template <class Visit, class Question>
HWY_INLINE size_t walkTree(const PlacedBvh& tree, Question& question, Array<Visit>& visits, uint32_t* kept,
                           HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    visits.clear();
    question.begin(visits.emplace_back());
    size_t count = 0, fetched = 0;
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched) prefetch(tree.nodes[visits[fetched].node]);
        const Visit visit = visits[at];
        SIGHTLINE_DEBUG_ASSERT(visit.node < tree.nodes.size());
        const BvhNode& node = tree.nodes[visit.node];
        ++stats.nodes;
        const SlotKinds used = kindsOf(node);
        const SlotBits slots = question.ask(visit, node, used.items | used.nodes);
        if (const uint32_t items = slots.live & used.items) {
            question.mark(items, count);
            count += takePlaced(tree, node, items, kept + count);
        }
        for (uint32_t below = slots.live & used.nodes; below != 0; below &= below - 1) {
            const int slot = std::countr_zero(below);
            if (slots.held >> slot & 1) {
                ++stats.inside_nodes;
                const size_t taken = takeBelow(tree, node, slot, kept + count);
                question.mark(slot, count, taken);
                count += taken;
            } else {
                hwy::Prefetch(&tree.order[node.first[slot]]);
                Visit& next = visits.emplace_back();
                next.node = node.child[slot];
                question.goBelow(visit, slot, next);
            }
        }
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // toggle
