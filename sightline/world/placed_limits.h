// Objects' own limits for the stages of distance and contribution, in the hierarchy's order.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/memory.h"
#include "sightline/base/paged.h"
#include "sightline/tree/world_bvh.h"
#include "sightline/world/world_object.h"

namespace sightline::detail {

/// The limits by place of the hierarchy, and bounds on them below each node. Empty: no object has limits of its own.
struct PlacedLimits {
    struct One {
        double factor = 1;        ///< infinity: neither stage culls it
        double max_distance = 0;  ///< 0: QuerySettings::max_distance
    };
    struct Below {
        double factor = 0;        ///< the largest; infinity: some object is never culled
        double max_distance = 0;  ///< the largest that is an object's own
        bool views = false;       ///< QuerySettings::max_distance holds for some object
        bool operator==(const Below&) const = default;
    };
    struct Node {
        Below below[8];  ///< of the node's slots
    };
    Paged<One, 256> objects;  ///< per place
    Paged<Node, 32> nodes;    ///< of the hierarchy's numbers

    explicit PlacedLimits(Memory* memory) : objects(memory), nodes(memory) {}
    bool empty() const { return objects.empty(); }
    void clear() {
        objects.clear();
        nodes.clear();
    }
    PlacedLimits share(Memory* memory) {
        PlacedLimits copy(memory);
        copy.objects = objects.share();
        copy.nodes = nodes.share();
        return copy;
    }
};

PlacedLimits::One placedLimits(const ObjectLimits& limits);

/// Notes anew what holds below nodes; `objects` is known. O(nodes), and writes what has changed.
void noteLimitsBelow(const PlacedBvh& bvh, PlacedLimits& limits);

}  // namespace sightline::detail
