// Keeps the items of a living hierarchy that may touch a view frustum.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/cull/hierarchy.h"

#include <bit>
#include <cmath>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/hierarchy.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;
using U8 = hn::RebindToUnsigned<F8>;

struct Slots {
    uint32_t outside = 0;  ///< bit per slot
    uint32_t inside[6];    ///< per plane: bit per slot
};

/// The arithmetic is that of cullFrustum(), in its order.
HWY_INLINE Slots testSlots(const RelativePlanes& planes, const BvhNode& node, uint32_t active) {
    const F8 d;
    Slots slots;
    for (uint32_t plane = 0; plane < planes.count; ++plane) {
        slots.inside[plane] = 0xff;
        if (!(active >> plane & 1)) continue;
        const float* normal = planes.normal[plane];
        const float* far_corner[3];
        const float* near_corner[3];
        for (int axis = 0; axis < 3; ++axis) {
            far_corner[axis] = normal[axis] >= 0 ? node.max[axis] : node.min[axis];
            near_corner[axis] = normal[axis] >= 0 ? node.min[axis] : node.max[axis];
        }
        const auto nx = hn::Set(d, normal[0]), ny = hn::Set(d, normal[1]), nz = hn::Set(d, normal[2]);
        const auto distance = hn::Set(d, planes.distance[plane]);
        uint32_t inside = 0;
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const auto at = [&](const float* const(&corner)[3]) HWY_ATTR {
                const auto x = hn::Mul(nx, hn::Load(d, corner[0] + i));
                const auto y = hn::Mul(ny, hn::Load(d, corner[1] + i));
                const auto z = hn::Mul(nz, hn::Load(d, corner[2] + i));
                return hn::Add(hn::Add(x, y), hn::Add(z, distance));
            };
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Lt(at(far_corner), hn::Zero(d)), bits);
            slots.outside |= uint32_t{bits[0]} << i;
            hn::StoreMaskBits(d, hn::Ge(at(near_corner), hn::Zero(d)), bits);
            inside |= uint32_t{bits[0]} << i;
        }
        slots.inside[plane] = inside;
    }
    return slots;
}

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
        const Slots slots = testSlots(planes, node, visit.planes);
        count += takeItems(node, ~slots.outside & 0xff, kept + count, nodes);
        for (; nodes != 0; nodes &= nodes - 1) {
            const int slot = std::countr_zero(nodes);
            uint32_t left = 0;
            for (uint32_t plane = 0; plane < planes.count; ++plane) left |= (~slots.inside[plane] >> slot & 1) << plane;
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

RelativePlanes relativePlanes(const Frustum& frustum, const glm::dvec3& origin, float reach) {
    constexpr float kRounding = 0x1p-19f;  // as in cullFrustum()
    RelativePlanes planes;
    planes.count = frustum.count;
    const glm::dvec3 shift = origin - frustum.eye;
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec4& p = frustum.planes[i];
        double size = std::abs(p.w) + std::abs(glm::dot(glm::dvec3(p), shift));
        for (int axis = 0; axis < 3; ++axis) {
            planes.normal[i][axis] = static_cast<float>(p[axis]);
            size += std::abs(p[axis]) * reach;
        }
        planes.distance[i] = static_cast<float>(p.w + glm::dot(glm::dvec3(p), shift) + kRounding * size);
    }
    return planes;
}

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
