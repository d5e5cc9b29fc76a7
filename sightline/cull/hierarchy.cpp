// Keeps the items of a living hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/cull/hierarchy.h"

#include <bit>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/hierarchy.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/relative_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using U8 = hn::CappedTag<uint32_t, 8>;

/// Writes the items among the slots that are left, and returns how many; `nodes` becomes the nodes among them.
HWY_INLINE size_t takeItems(const BvhNode& node, uint32_t left, uint32_t* kept, uint32_t& nodes) {
    const U8 d;
    size_t count = 0;
    nodes = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const auto child = hn::Load(d, node.child + i);
        const auto is_item = hn::Ne(hn::And(child, hn::Set(d, BvhNode::kLeaf)), hn::Zero(d));
        const auto used = hn::Ne(child, hn::Set(d, ~0u));
        uint8_t bits[8] = {static_cast<uint8_t>(left >> i)};
        const auto wanted = hn::And(hn::LoadMaskBits(d, bits), used);
        uint8_t node_bits[8] = {};
        hn::StoreMaskBits(d, hn::AndNot(is_item, wanted), node_bits);
        nodes |= uint32_t{node_bits[0]} << i;
        const auto item = hn::And(child, hn::Set(d, ~BvhNode::kLeaf));
        count += hn::CompressStore(item, hn::And(wanted, is_item), d, kept + count);
    }
    return count;
}

HWY_INLINE void prefetch(const BvhNode& node, bool bounds) {
    const char* at = reinterpret_cast<const char*>(&node);
    hwy::Prefetch(at + 192);
    if (!bounds) return;
    hwy::Prefetch(at);
    hwy::Prefetch(at + 64);
    hwy::Prefetch(at + 128);
}

size_t cullHierarchyKernel(const RelativePlanes& planes, const LivingBvh& tree, HierarchyScratch& scratch,
                           uint32_t* kept, HierarchyStats& stats) {
    Array<HierarchyScratch::Visit>& stack = scratch.stack;
    stack.assign(1, {tree.root, (1u << planes.count) - 1});
    size_t count = 0;
    while (!stack.empty()) {
        const HierarchyScratch::Visit visit = stack.back();
        stack.pop_back();
        const BvhNode& node = tree.node(visit.node);
        uint32_t nodes = 0;
        if (visit.planes == 0) {
            ++stats.inside_nodes;
            count += takeItems(node, 0xff, kept + count, nodes);
            for (; nodes != 0; nodes &= nodes - 1) {
                const uint32_t child = node.child[std::countr_zero(nodes)];
                prefetch(tree.node(child), false);
                stack.push_back({child, 0});
            }
            continue;
        }
        ++stats.nodes;
        stats.plane_tests += static_cast<uint64_t>(std::popcount(visit.planes));
        const SlotAnswer slots = testSlots(planes, node, visit.planes);
        count += takeItems(node, ~slots.outside & 0xff, kept + count, nodes);
        for (; nodes != 0; nodes &= nodes - 1) {
            const int slot = std::countr_zero(nodes);
            const uint32_t left = planesLeft(planes, slots, slot);
            prefetch(tree.node(node.child[slot]), left != 0);
            stack.push_back({node.child[slot], left});
        }
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(cullHierarchyKernel);

size_t cullHierarchy(const Frustum& frustum, const LivingBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                     HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.count} + 8);
    HierarchyStats done;
    size_t count = 0;
    for (uint32_t item : tree.unbounded) kept[count++] = item;
    if (tree.root != LivingBvh::kNone)
        count += HWY_DYNAMIC_DISPATCH(cullHierarchyKernel)(relativePlanes(frustum, tree.origin, tree.reach()), tree,
                                                           scratch, kept.data() + count, done);
    if (stats) *stats = done;
    return count;
}

}  // namespace sightline
#endif  // HWY_ONCE
