// One walk over a living hierarchy for several frusta.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "sightline/base/assert.h"
#include "sightline/cull/hierarchy.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/hierarchy_many.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/living_node-inl.h"
#include "sightline/cull/relative_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Eight bits as the lowest bits of eight bytes.
HWY_INLINE uint64_t spread(uint32_t bits) {
    const uint64_t each = (bits * 0x0101010101010101ull) & 0x8040201008040201ull;  // bit i in byte i
    return ((each + 0x00406070787C7E7Full) >> 7) & 0x0101010101010101ull;
}

/// Sets a frustum's bit in the masks of some slots.
HWY_INLINE void addBit(uint32_t slots, uint32_t frustum, uint32_t* masks) {
    const U8 d;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const uint8_t bits[8] = {static_cast<uint8_t>(slots >> i)};
        const auto bit = hn::IfThenElseZero(hn::LoadMaskBits(d, bits), hn::Set(d, 1u << frustum));
        hn::Store(hn::Or(hn::Load(d, masks + i), bit), d, masks + i);
    }
}

/// Level by level, as the walk for one frustum.
size_t cullManyKernel(const RelativePlanes* frusta, uint32_t frustum_count, const LivingBvh& tree,
                      HierarchyScratch& scratch, uint32_t* kept, uint32_t* kept_masks, HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    Array<HierarchyScratch::ManyVisit>& visits = scratch.many_visits;
    HierarchyScratch::ManyVisit top;
    top.node = tree.root;
    top.live = static_cast<uint32_t>((uint64_t{1} << frustum_count) - 1);
    for (uint32_t i = 0; i < frustum_count; ++i) top.planes[i] = static_cast<uint8_t>((1u << frusta[i].count) - 1);
    visits.assign(1, top);
    size_t count = 0, fetched = 0;
    alignas(64) uint32_t masks[8];
    uint64_t left[kMostFrusta] = {};  // per frustum: a byte per slot, the planes that it is not inside of
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched)
            prefetch(tree.node(visits[fetched].node), visits[fetched].crossing);
        const HierarchyScratch::ManyVisit visit = visits[at];
        const BvhNode& node = tree.node(visit.node);
        uint32_t inside = 0;
        for (uint32_t bits = visit.live; bits != 0; bits &= bits - 1) {
            const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
            inside |= uint32_t{visit.planes[i] == 0} << i;
        }
        std::fill_n(masks, 8, inside);
        for (uint32_t bits = inside; bits != 0; bits &= bits - 1) left[std::countr_zero(bits)] = 0;
        const uint32_t crossing = visit.live & ~inside;
        ++(crossing ? stats.nodes : stats.inside_nodes);
        for (uint32_t bits = crossing; bits != 0; bits &= bits - 1) {
            const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
            const RelativePlanes& planes = frusta[i];
            stats.plane_tests += static_cast<uint64_t>(std::popcount(uint32_t{visit.planes[i]}));
            const SlotAnswer slots = testSlots(planes, node, visit.planes[i]);
            addBit(~slots.outside & 0xff, i, masks);
            left[i] = 0;
            for (uint32_t plane = 0; plane < planes.count; ++plane)
                left[i] |= spread(~slots.inside[plane] & 0xff) << plane;
        }
        uint32_t nodes = 0;
        count += takeItems(node, masks, kept + count, kept_masks + count, nodes);
        for (; nodes != 0; nodes &= nodes - 1) {
            const int slot = std::countr_zero(nodes);
            HierarchyScratch::ManyVisit& next = visits.emplace_back();
            next.node = node.child[slot];
            next.live = masks[slot];
            uint32_t any = 0;
            for (uint32_t bits = next.live; bits != 0; bits &= bits - 1) {
                const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
                next.planes[i] = static_cast<uint8_t>(left[i] >> (8 * slot));
                any |= next.planes[i];
            }
            next.crossing = any != 0;
        }
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(cullManyKernel);

size_t cullHierarchy(std::span<const Frustum> frusta, const LivingBvh& tree, HierarchyScratch& scratch,
                     std::span<uint32_t> kept, std::span<uint32_t> masks, HierarchyStats* stats) {
    SIGHTLINE_ASSERT(!frusta.empty() && frusta.size() <= kMostFrusta);
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.count} + 8 && masks.size() >= size_t{tree.count} + 8);
    const uint32_t frustum_count = static_cast<uint32_t>(frusta.size());
    HierarchyStats done;
    size_t count = 0;
    for (uint32_t item : tree.unbounded) {
        masks[count] = static_cast<uint32_t>((uint64_t{1} << frustum_count) - 1);
        kept[count++] = item;
    }
    if (tree.root != LivingBvh::kNone) {
        RelativePlanes planes[kMostFrusta];
        const float reach = tree.reach();
        for (uint32_t i = 0; i < frustum_count; ++i) planes[i] = relativePlanes(frusta[i], tree.origin, reach);
        count += HWY_DYNAMIC_DISPATCH(cullManyKernel)(planes, frustum_count, tree, scratch, kept.data() + count,
                                                      masks.data() + count, done);
    }
    if (stats) *stats = done;
    return count;
}

}  // namespace sightline
#endif  // HWY_ONCE
