// One walk over a living hierarchy for several frusta.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cstring>

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

/// Bytes, eight frusta's bits of each slot in one, as a mask a slot.
HWY_INLINE void widen(const uint64_t (&groups)[kMostFrusta / 8], uint32_t group_count, uint32_t inside,
                      uint32_t* masks) {
    const U8 d;
    const hn::Rebind<uint8_t, U8> bytes;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto mask = hn::Set(d, inside);
        for (uint32_t group = 0; group < group_count; ++group) {
            uint8_t slots[8];
            std::memcpy(slots, &groups[group], 8);
            const auto part = hn::PromoteTo(d, hn::LoadU(bytes, slots + i));
            mask = hn::Or(mask, hn::ShiftLeftSame(part, static_cast<int>(8 * group)));
        }
        hn::Store(mask, d, masks + i);
    }
}

/// Level by level, as the walk for one frustum.
size_t cullManyKernel(const RelativePlanes* frusta, uint32_t frustum_count, const LivingBvh& tree,
                      HierarchyScratch& scratch, uint32_t* kept, uint32_t* kept_masks, HierarchyStats& stats) {
    constexpr size_t kAhead = 8;
    const uint32_t group_count = (frustum_count + 7) / 8;
    Array<HierarchyScratch::ManyVisit>& visits = scratch.many_visits;
    HierarchyScratch::ManyVisit top;
    top.node = tree.root;
    top.live = static_cast<uint32_t>((uint64_t{1} << frustum_count) - 1);
    for (uint32_t i = 0; i < frustum_count; ++i) {
        top.planes[i] = static_cast<uint8_t>((1u << frusta[i].count) - 1);
        top.crossing |= uint32_t{frusta[i].count > 0} << i;
    }
    visits.assign(1, top);
    size_t count = 0, fetched = 0;
    alignas(64) uint32_t masks[8];
    uint64_t left[kMostFrusta];  // per frustum: a byte per slot, the planes that it is not inside of
    for (size_t at = 0; at < visits.size(); ++at) {
        for (; fetched < std::min(visits.size(), at + kAhead); ++fetched)
            prefetch(tree.node(visits[fetched].node), visits[fetched].crossing != 0);
        const HierarchyScratch::ManyVisit visit = visits[at];
        const BvhNode& node = tree.node(visit.node);
        uint32_t nodes = 0;
        if (visit.crossing == 0) {
            ++stats.inside_nodes;
            const size_t taken = takeItems(node, 0xff, kept + count, nodes);
            std::fill_n(kept_masks + count, 8, visit.live);
            count += taken;
            for (; nodes != 0; nodes &= nodes - 1) {
                HierarchyScratch::ManyVisit& next = visits.emplace_back();
                next.node = node.child[std::countr_zero(nodes)];
                next.live = visit.live;
            }
            continue;
        }
        ++stats.nodes;
        uint64_t groups[kMostFrusta / 8] = {};
        for (uint32_t bits = visit.crossing; bits != 0; bits &= bits - 1) {
            const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
            const RelativePlanes& planes = frusta[i];
            stats.plane_tests += static_cast<uint64_t>(std::popcount(uint32_t{visit.planes[i]}));
            const SlotAnswer slots = testSlots(planes, node, visit.planes[i]);
            groups[i / 8] |= spread(~slots.outside & 0xff) << (i % 8);
            uint64_t crossed = 0;
            for (uint32_t asked = visit.planes[i]; asked != 0; asked &= asked - 1) {
                const int plane = std::countr_zero(asked);
                crossed |= spread(~slots.inside[plane] & 0xff) << plane;
            }
            left[i] = crossed;
        }
        widen(groups, group_count, visit.live & ~visit.crossing, masks);
        count += takeItems(node, masks, kept + count, kept_masks + count, nodes);
        for (; nodes != 0; nodes &= nodes - 1) {
            const int slot = std::countr_zero(nodes);
            HierarchyScratch::ManyVisit& next = visits.emplace_back();
            next.node = node.child[slot];
            next.live = masks[slot];
            for (uint32_t bits = next.live & visit.crossing; bits != 0; bits &= bits - 1) {
                const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
                next.planes[i] = static_cast<uint8_t>(left[i] >> (8 * slot));
                next.crossing |= uint32_t{next.planes[i] != 0} << i;
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
