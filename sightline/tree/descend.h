// The descent over a tree of eight-wide nodes: level by level, or by whatever is first in a queue.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>

#include "sightline/base/assert.h"
#include "sightline/tree/bvh.h"

namespace sightline {

/// Bit per slot of a node that has a child.
inline uint32_t usedSlots(const BvhNode& node) {
    uint32_t used = 0;
    for (int slot = 0; slot < 8; ++slot) used |= uint32_t{node.count[slot] != 0} << slot;
    return used;
}

/// Calls visit(slot) for each bit, the lowest first.
template <class Visit>
void forEachSlot(uint32_t slots, Visit&& visit) {
    SIGHTLINE_DEBUG_ASSERT(slots <= 0xff);
    for (; slots; slots &= slots - 1) visit(std::countr_zero(slots));
}

/// Opens the nodes that wait, and those that join them meanwhile, level by level, so that they can be fetched ahead.
/// @param nodes  of the tree
/// @param line   what waits; each has the node's number as `node`. Stays as it is
/// @param open   open(entry): looks at a node's children and appends those to `line` that are to be opened
template <class Nodes, class Line, class Open>
void descendByLevels(const Nodes& nodes, Line& line, Open&& open) {
    constexpr size_t kAhead = 8;
    for (size_t at = 0; at < line.size(); ++at) {
        if (at + kAhead < line.size()) {
            const char* ahead = reinterpret_cast<const char*>(&nodes[line[at + kAhead].node]);
            for (size_t byte = 0; byte < sizeof(BvhNode); byte += 64) hwy::Prefetch(ahead + byte);
        }
        const auto entry = line[at];
        SIGHTLINE_DEBUG_ASSERT(entry.node < nodes.size());
        open(entry);
    }
}

/// Takes what is first in a queue, until nothing waits or enough is known.
/// @param queue   pop() gives what is first
/// @param waits   waits(): whether to go on
/// @param take    take(entry): opens a node or decides on a leaf, and queues what follows
template <class Queue, class Waits, class Take>
void descendInOrder(Queue& queue, Waits&& waits, Take&& take) {
    while (waits()) take(queue.pop());
}

}  // namespace sightline
