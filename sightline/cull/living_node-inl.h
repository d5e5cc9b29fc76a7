// What walks of a living hierarchy do with one node: items taken, nodes left; once per instruction set.
// SPDX-License-Identifier: MIT
#include "sightline/space/bvh.h"

#if defined(SIGHTLINE_CULL_LIVING_NODE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULL_LIVING_NODE_INL_H_
#undef SIGHTLINE_CULL_LIVING_NODE_INL_H_
#else
#define SIGHTLINE_CULL_LIVING_NODE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

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

/// The same where each slot has a mask: what has none is left out.
/// @param masks  [size: 8, aligned]
/// @param of     receives the masks of the items
HWY_INLINE size_t takeItems(const BvhNode& node, const uint32_t* masks, uint32_t* kept, uint32_t* of, uint32_t& nodes) {
    const U8 d;
    size_t count = 0;
    nodes = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const auto child = hn::Load(d, node.child + i), mask = hn::Load(d, masks + i);
        const auto is_item = hn::Ne(hn::And(child, hn::Set(d, BvhNode::kLeaf)), hn::Zero(d));
        const auto wanted = hn::And(hn::Ne(mask, hn::Zero(d)), hn::Ne(child, hn::Set(d, ~0u)));
        uint8_t node_bits[8] = {};
        hn::StoreMaskBits(d, hn::AndNot(is_item, wanted), node_bits);
        nodes |= uint32_t{node_bits[0]} << i;
        const auto taken = hn::And(wanted, is_item);
        hn::CompressStore(mask, taken, d, of + count);
        count += hn::CompressStore(hn::And(child, hn::Set(d, ~BvhNode::kLeaf)), taken, d, kept + count);
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

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // toggle
