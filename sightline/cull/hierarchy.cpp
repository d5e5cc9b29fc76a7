// Keeps the items of a living hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/cull/hierarchy.h"

#include <algorithm>
#include <bit>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/hierarchy.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/living_node-inl.h"
#include "sightline/cull/relative_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Level by level, so that what comes next is known early enough to be fetched.
size_t cullHierarchyKernel(const RelativePlanes& planes, const LivingBvh& tree, HierarchyScratch& scratch,
                           uint32_t* kept, HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    Array<HierarchyScratch::Visit>& visits = scratch.visits;
    visits.assign(1, {tree.root, (1u << planes.count) - 1});
    size_t count = 0, fetched = 0;
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched)
            prefetch(tree.node(visits[fetched].node), visits[fetched].planes != 0);
        const HierarchyScratch::Visit visit = visits[at];
        const BvhNode& node = tree.node(visit.node);
        uint32_t nodes = 0;
        if (visit.planes == 0) {
            ++stats.inside_nodes;
            count += takeItems(node, 0xff, kept + count, nodes);
            for (; nodes != 0; nodes &= nodes - 1) visits.push_back({node.child[std::countr_zero(nodes)], 0});
            continue;
        }
        ++stats.nodes;
        stats.plane_tests += static_cast<uint64_t>(std::popcount(visit.planes));
        const SlotAnswer slots = testSlots(planes, node, visit.planes);
        count += takeItems(node, ~slots.outside & 0xff, kept + count, nodes);
        for (; nodes != 0; nodes &= nodes - 1) {
            const int slot = std::countr_zero(nodes);
            visits.push_back({node.child[slot], planesLeft(planes, slots, slot)});
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
