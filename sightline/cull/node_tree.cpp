// Keeps the items of a scene's own hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
#include "sightline/cull/node_tree.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/node_tree.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/living_node-inl.h"
#include "sightline/cull/relative_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Level by level, so that what comes next is known early enough to be fetched.
size_t cullNodeTreeKernel(const RelativePlanes& planes, const NodeTreeBounds& tree, HierarchyScratch& scratch,
                          uint32_t* kept, HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    Array<HierarchyScratch::Visit>& visits = scratch.visits;
    visits.assign(1, {0, (1u << planes.count) - 1});
    size_t count = 0, fetched = 0;
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched)
            prefetch(tree.blocks[tree.branches[visits[fetched].node].first_block], true);
        const HierarchyScratch::Visit visit = visits[at];
        const NodeTreeBounds::Branch& branch = tree.branches[visit.node];
        stats.nodes += branch.block_count;
        stats.plane_tests += static_cast<uint64_t>(std::popcount(visit.planes)) * branch.block_count;
        for (uint32_t i = branch.first_block; i < branch.first_block + branch.block_count; ++i) {
            const BvhNode& block = tree.blocks[i];
            const SlotAnswer slots = testSlots(planes, block, visit.planes);
            uint32_t branches = 0;
            count += takeItems(block, ~slots.outside & 0xff, kept + count, branches);
            for (; branches != 0; branches &= branches - 1) {
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
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

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

}  // namespace sightline
#endif  // HWY_ONCE
