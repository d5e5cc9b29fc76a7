// Objects' own limits for the stages of distance and contribution, in the hierarchy's order.
// SPDX-License-Identifier: MIT
#include "sightline/world/placed_limits.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

void add(const PlacedLimits::Below& from, PlacedLimits::Below& to) {
    to.factor = std::max(to.factor, from.factor);
    to.max_distance = std::max(to.max_distance, from.max_distance);
    to.views |= from.views;
}

PlacedLimits::Below noteNode(const PlacedBvh& bvh, uint32_t index, PlacedLimits& limits) {
    SIGHTLINE_DEBUG_ASSERT(index < bvh.nodes.size() && limits.nodes.size() == bvh.nodes.size());
    const BvhNode& node = bvh.nodes[index];
    PlacedLimits::Below all;
    for (int slot = 0; slot < 8; ++slot) {
        PlacedLimits::Below below;
        if (node.count[slot] > 0) {
            if (node.child[slot] & BvhNode::kLeaf) {
                const PlacedLimits::One& one = limits.objects[node.first[slot]];
                below = {one.factor, one.max_distance, one.max_distance == 0.0};
            } else {
                below = noteNode(bvh, node.child[slot], limits);
            }
        }
        if (!(limits.nodes[index].below[slot] == below)) limits.nodes.change(index).below[slot] = below;
        add(below, all);
    }
    return all;
}

}  // namespace

PlacedLimits::One placedLimits(const ObjectLimits& limits) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    PlacedLimits::One one;
    const bool culled = !limits.always && limits.factor > 0.0 && limits.factor < kInfinity;
    one.factor = culled ? limits.factor : kInfinity;
    one.max_distance = limits.max_distance > 0.0 ? limits.max_distance : 0.0;
    return one;
}

void noteLimitsBelow(const PlacedBvh& bvh, PlacedLimits& limits) {
    SIGHTLINE_DEBUG_ASSERT(limits.objects.size() == bvh.order.size());
    limits.nodes.resize(bvh.nodes.size());
    if (!bvh.nodes.empty()) noteNode(bvh, 0, limits);
}

}  // namespace sightline::detail
