// Keeps the items of a scene's own hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/node_tree.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/frustum/node_tree_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/relative_planes-inl.h"
#include "sightline/cull/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
using namespace sightline::HWY_NAMESPACE;

/// Level by level, so that what comes next is known early enough to be fetched.
size_t cullNodeTreeKernel(const RelativePlanes& planes, const NodeTreeBounds& tree, HierarchyScratch& scratch,
                          uint32_t* kept, HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    Array<HierarchyScratch::Visit>& visits = scratch.visits;
    visits.assign(1, {0, (1u << planes.count) - 1});
    size_t count = 0, fetched = 0;
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched)
            prefetch(tree.blocks[tree.branches[visits[fetched].node].first_block]);
        const HierarchyScratch::Visit visit = visits[at];
        const NodeTreeBounds::Branch& branch = tree.branches[visit.node];
        stats.nodes += branch.block_count;
        stats.plane_tests += static_cast<uint64_t>(std::popcount(visit.planes)) * branch.block_count;
        for (uint32_t i = branch.first_block; i < branch.first_block + branch.block_count; ++i) {
            const BvhNode& block = tree.blocks[i];
            const SlotAnswer slots = testSlots(planes, block, visit.planes);
            const SlotKinds used = kindsOf(block);
            count += takeItems(block, used.items & ~slots.outside, kept + count,
                               [](hn::Vec<U8> item) HWY_ATTR { return item; });
            for (uint32_t branches = used.nodes & ~slots.outside; branches != 0; branches &= branches - 1) {
                const int slot = std::countr_zero(branches);
                const uint32_t left = planesLeft(planes, slots, slot);
                if (left != 0) {
                    visits.push_back({block.child[slot], left});
                    continue;
                }
                ++stats.inside_nodes;
                std::memcpy(kept + count, tree.order.data() + block.first[slot], block.count[slot] * sizeof(uint32_t));
                count += block.count[slot];
            }
        }
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {

HWY_EXPORT(cullNodeTreeKernel);

size_t cullNodeTree(const Frustum& frustum, const NodeTreeBounds& tree, HierarchyScratch& scratch,
                    std::span<uint32_t> kept, HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= tree.order.size() + 8);
    HierarchyStats done;
    size_t count = 0;
    if (!tree.branches.empty())
        count = HWY_DYNAMIC_DISPATCH(cullNodeTreeKernel)(relativePlanes(frustum, tree.origin, tree.reach), tree,
                                                         scratch, kept.data(), done);
    if (stats) *stats = done;
    return count;
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
