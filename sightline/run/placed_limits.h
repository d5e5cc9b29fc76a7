// Objects' own limits for the stages of distance and contribution, in the hierarchy's order.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/memory.h"
#include "sightline/base/paged.h"
#include "sightline/run/world.h"
#include "sightline/space/growing_bvh.h"

namespace sightline::detail {

/// Per place of the hierarchy, and what holds for all below a node. Of none: no object has limits of its own.
struct PlacedLimits {
    struct One {
        double factor = 1;        ///< infinity: neither stage culls it
        double max_distance = 0;  ///< 0: the view's
    };
    struct Below {
        double factor = 0;        ///< the largest; infinity: some object is never culled
        double max_distance = 0;  ///< the largest that is an object's own
        bool views = false;       ///< the view's distance holds for some
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
