// The items whose boxes overlap a box: what a light reaches, what a blast hits, what a region of a map holds.
// SPDX-License-Identifier: MIT
//
// Antonin Guttman. R-Trees: A Dynamic Index Structure for Spatial Searching. 1984.
#include "sightline/cull/box_query.h"

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/box_query.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/cull/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D8 = hn::CappedTag<float, 8>;
using D16 = hn::CappedTag<float, 16>;

/// Lanes of boxes that overlap the box; what is not a number separates nothing.
template <class D, class Load>
HWY_INLINE hn::Mask<D> overlaps(D d, const Box3f& box, const Load& load) {
    auto apart = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
        apart = hn::Or(apart, hn::Gt(load(0, axis), hn::Set(d, box.max[axis])));
        apart = hn::Or(apart, hn::Lt(load(1, axis), hn::Set(d, box.min[axis])));
    }
    return hn::Not(apart);
}

/// Lanes of boxes that lie within the box.
template <class D, class Load>
HWY_INLINE hn::Mask<D> within(D d, const Box3f& box, const Load& load) {
    auto beyond = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
        beyond = hn::Or(beyond, hn::Not(hn::Ge(load(0, axis), hn::Set(d, box.min[axis]))));
        beyond = hn::Or(beyond, hn::Not(hn::Le(load(1, axis), hn::Set(d, box.max[axis]))));
    }
    return hn::Not(beyond);
}

/// What a box asks.
struct OneBox {
    using Visit = HierarchyScratch::Visit;

    const Box3f& box;

    void begin(Visit&) const {}
    HWY_INLINE SlotBits ask(const Visit&, const BvhNode& node, uint32_t) const {
        const D8 d;
        SlotBits slots;
        for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const auto load = [&](int side, int axis)
                                  HWY_ATTR { return hn::Load(d, (side ? node.max : node.min)[axis] + i); };
            slots.live |= bitsOf(d, overlaps(d, box, load), i);
            slots.held |= bitsOf(d, within(d, box, load), i);
        }
        return slots;
    }
    void goBelow(const Visit&, int, Visit&) const {}
    void mark(uint32_t, size_t) const {}
    void mark(int, size_t, size_t) const {}
};

size_t takeTree(const Box3f& box, const PlacedBvh& tree, HierarchyScratch& scratch, uint32_t* kept,
                HierarchyStats& stats) {
    OneBox question{box};
    return walkTree(tree, question, scratch.visits, kept, stats);
}

size_t takeFlat(const Box3f& box, const BoxArrays& boxes, uint32_t* kept) {
    const D16 d;
    const hn::RebindToUnsigned<D16> u;
    size_t count = 0;
    for (size_t i = 0; i < boxes.count; i += hn::Lanes(d)) {
        const auto load = [&](int side, int axis)
                              HWY_ATTR { return hn::LoadU(d, (side ? boxes.max : boxes.min)[axis] + i); };
        const auto taken = hn::And(hn::FirstN(d, boxes.count - i), overlaps(d, box, load));
        const auto index = hn::Iota(u, static_cast<uint32_t>(i));
        count += hn::CompressStore(index, hn::RebindMask(u, taken), u, kept + count);
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

HWY_EXPORT(takeTree);
HWY_EXPORT(takeFlat);

bool isEmpty(const Box3d& box) {
    return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;  // what is NaN is not
}

}  // namespace

size_t queryBox(const Box3d& box, const PlacedBvh& tree, HierarchyScratch& scratch, std::span<uint32_t> kept,
                HierarchyStats* stats) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.size()} + 8);
    HierarchyStats done;
    size_t count = 0;
    if (!tree.nodes.empty() && !isEmpty(box))
        count = HWY_DYNAMIC_DISPATCH(takeTree)(roundOutward(box, tree.origin), tree, scratch, kept.data(), done);
    if (stats) *stats = done;
    return count;
}

size_t queryBox(const Box3d& box, const BoxArrays& boxes, std::span<uint32_t> kept) {
    SIGHTLINE_DEBUG_ASSERT(kept.size() >= (boxes.count + 15) / 16 * 16);
    if (isEmpty(box)) return 0;
    return HWY_DYNAMIC_DISPATCH(takeFlat)(roundOutward(box, boxes.origin), boxes, kept.data());
}

}  // namespace sightline
#endif  // HWY_ONCE
