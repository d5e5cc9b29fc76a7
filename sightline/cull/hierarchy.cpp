// Keeps the items of a world's hierarchy that may touch a view frustum, or any of several.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/cull/hierarchy.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/hierarchy.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/relative_planes-inl.h"
#include "sightline/cull/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What one frustum asks.
struct OneFrustum {
    using Visit = HierarchyScratch::Visit;

    const RelativePlanes& planes;
    HierarchyStats& stats;
    SlotAnswer answer = {};

    void begin(Visit& root) const { root.planes = (1u << planes.count) - 1; }
    HWY_INLINE SlotBits ask(const Visit& visit, const BvhNode& node, uint32_t) {
        stats.plane_tests += static_cast<uint64_t>(std::popcount(visit.planes));
        answer = testSlots(planes, node, visit.planes);
        SlotBits slots{~answer.outside, 0xff};
        for (uint32_t plane = 0; plane < planes.count; ++plane) slots.held &= answer.inside[plane];
        return slots;
    }
    HWY_INLINE void goBelow(const Visit&, int slot, Visit& next) const {
        next.planes = planesLeft(planes, answer, slot);
    }
    void mark(uint32_t, size_t) const {}
    void mark(int, size_t, size_t) const {}
};

/// Eight bits as the lowest bits of eight bytes.
HWY_INLINE uint64_t spread(uint32_t bits) {
    const uint64_t each = (bits * 0x0101010101010101ull) & 0x8040201008040201ull;  // bit i in byte i
    return ((each + 0x00406070787C7E7Full) >> 7) & 0x0101010101010101ull;
}

/// A bit per slot and frustum.
struct FrustumBits {
    uint64_t groups[kMostFrusta / 8] = {};  ///< of eight frusta each: a byte per slot

    HWY_INLINE void set(uint32_t frustum, uint32_t slots) {
        SIGHTLINE_DEBUG_ASSERT(frustum < kMostFrusta);
        groups[frustum / 8] |= spread(slots & 0xff) << (frustum % 8);
    }
    /// Writes a mask per slot, with the bits of `every` in each.
    HWY_INLINE void widen(uint32_t group_count, uint32_t every, uint32_t* masks) const {
        const U8 u;
        const hn::Rebind<uint8_t, U8> bytes;
        for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
            auto mask = hn::Set(u, every);
            for (uint32_t group = 0; group < group_count; ++group) {
                uint8_t slots[8];
                std::memcpy(slots, &groups[group], 8);
                const auto part = hn::PromoteTo(u, hn::LoadU(bytes, slots + i));
                mask = hn::Or(mask, hn::ShiftLeftSame(part, static_cast<int>(8 * group)));
            }
            hn::Store(mask, u, masks + i);
        }
    }
};

/// What several frusta ask.
struct ManyFrusta {
    using Visit = HierarchyScratch::ManyVisit;

    const RelativePlanes* frusta;
    uint32_t frustum_count;
    uint32_t* of;  ///< per kept item: a bit per frustum
    HierarchyStats& stats;
    alignas(64) uint32_t live[8] = {};      ///< per slot: bit per frustum that it may touch
    alignas(64) uint32_t crossing[8] = {};  ///< per slot: of these, it is not inside of the frustum
    uint64_t left[kMostFrusta] =
        {};  ///< per frustum that is crossed: a byte per slot, the planes that it is not inside of

    void begin(Visit& root) const {
        root.live = static_cast<uint32_t>((uint64_t{1} << frustum_count) - 1);
        for (uint32_t i = 0; i < frustum_count; ++i) {
            root.planes[i] = static_cast<uint8_t>((1u << frusta[i].count) - 1);
            root.crossing |= uint32_t{frusta[i].count > 0} << i;
        }
    }
    HWY_INLINE SlotBits ask(const Visit& visit, const BvhNode& node, uint32_t) {
        FrustumBits touched, crossed;
        for (uint32_t bits = visit.crossing; bits != 0; bits &= bits - 1) {
            const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
            stats.plane_tests += static_cast<uint64_t>(std::popcount(uint32_t{visit.planes[i]}));
            const SlotAnswer answer = testSlots(frusta[i], node, visit.planes[i]);
            uint32_t not_inside = 0;
            left[i] = 0;
            for (uint32_t asked = visit.planes[i]; asked != 0; asked &= asked - 1) {
                const int plane = std::countr_zero(asked);
                not_inside |= ~answer.inside[plane];
                left[i] |= spread(~answer.inside[plane] & 0xff) << plane;
            }
            touched.set(i, ~answer.outside);
            crossed.set(i, ~answer.outside & not_inside);
        }
        const uint32_t group_count = (frustum_count + 7) / 8;
        touched.widen(group_count, visit.live & ~visit.crossing, live);
        crossed.widen(group_count, 0, crossing);
        SlotBits slots;
        const U8 u;
        for (size_t i = 0; i < 8; i += hn::Lanes(u)) {
            slots.live |= bitsOf(u, hn::Ne(hn::Load(u, live + i), hn::Zero(u)), i);
            slots.held |= bitsOf(u, hn::Eq(hn::Load(u, crossing + i), hn::Zero(u)), i);
        }
        return slots;
    }
    HWY_INLINE void goBelow(const Visit&, int slot, Visit& next) const {
        next.live = live[slot];
        next.crossing = crossing[slot];
        for (uint32_t bits = next.crossing; bits != 0; bits &= bits - 1) {
            const uint32_t i = static_cast<uint32_t>(std::countr_zero(bits));
            next.planes[i] = static_cast<uint8_t>(left[i] >> (8 * slot));
        }
    }
    HWY_INLINE void mark(uint32_t slots, size_t at) const {
        const U8 u;
        for (size_t i = 0; i < 8; i += hn::Lanes(u))
            at += hn::CompressStore(hn::Load(u, live + i), lanesOf(slots, i), u, of + at);
    }
    HWY_INLINE void mark(int slot, size_t at, size_t count) const { std::fill_n(of + at, count, live[slot]); }
};

size_t cullOne(const RelativePlanes& planes, const PlacedBvh& tree, HierarchyScratch& scratch, uint32_t* kept,
               HierarchyStats& stats) {
    OneFrustum question{planes, stats};
    return walkTree(tree, question, scratch.visits, kept, stats);
}

size_t cullMany(std::span<const RelativePlanes> frusta, const PlacedBvh& tree, HierarchyScratch& scratch,
                uint32_t* kept, uint32_t* masks, HierarchyStats& stats) {
    ManyFrusta question{frusta.data(), static_cast<uint32_t>(frusta.size()), masks, stats};
    return walkTree(tree, question, scratch.many_visits, kept, stats);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(cullOne);
HWY_EXPORT(cullMany);

size_t cullHierarchy(const Frustum& frustum, const PlacedBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                     HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.size()} + 8);
    HierarchyStats done;
    size_t count = 0;
    if (!tree.nodes.empty())
        count = HWY_DYNAMIC_DISPATCH(cullOne)(relativePlanes(frustum, tree.origin, tree.reach()), tree, scratch,
                                              kept.data(), done);
    if (stats) *stats = done;
    return count;
}

size_t cullHierarchy(std::span<const Frustum> frusta, const PlacedBvh& tree, HierarchyScratch& scratch,
                     std::span<uint32_t> kept, std::span<uint32_t> masks, HierarchyStats* stats) {
    SIGHTLINE_ASSERT(!frusta.empty() && frusta.size() <= kMostFrusta);
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.size()} + 8 && masks.size() >= size_t{tree.size()} + 8);
    HierarchyStats done;
    size_t count = 0;
    if (!tree.nodes.empty()) {
        RelativePlanes planes[kMostFrusta];
        const float reach = tree.reach();
        for (size_t i = 0; i < frusta.size(); ++i) planes[i] = relativePlanes(frusta[i], tree.origin, reach);
        count = HWY_DYNAMIC_DISPATCH(cullMany)({planes, frusta.size()}, tree, scratch, kept.data(), masks.data(), done);
    }
    if (stats) *stats = done;
    return count;
}

}  // namespace sightline
#endif  // HWY_ONCE
