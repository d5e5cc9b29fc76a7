// The queue of a traversal: nodes, objects and clusters that wait for their turn, nearest first.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/cull/occlusion.h"
#include "sightline/frame/place_range.h"

namespace sightline::detail {

/// A node, an object or an occluder's cluster that waits for its turn.
struct Pending {
    enum class Kind : uint8_t { kNode, kObject, kCluster };
    PixelRect rect;
    Box3f box;            ///< relative to the eye, each number rounded; not of a cluster
    uint32_t serial = 0;  ///< how many were queued before it
    uint32_t index = 0;   ///< node; place of the object; or cluster
    uint32_t owner = 0;   ///< of a cluster: index into TraversalState::instances
    PlaceRange below;     ///< the objects below
    uint32_t planes = 0;  ///< of a node: bit per plane of the view that the node is not inside of
    Kind kind = Kind::kNode;
    bool testable = false;  ///< `rect` bounds it; else it is in doubt, or outside and kept
};

/// Gives back the entry of the greatest nearness; of equals the one that was queued first.
class PendingQueue {
public:
    explicit PendingQueue(Memory* memory) : entries_(memory), heap_(memory) {}

    bool empty() const { return heap_.empty(); }
    void clear() {
        entries_.clear();
        heap_.clear();
    }

    void push(const Pending& entry) {
        SIGHTLINE_DEBUG_ASSERT(entry.rect.nearness == entry.rect.nearness);
        const uint32_t serial = static_cast<uint32_t>(entries_.size());
        entries_.push_back(entry);
        entries_.back().serial = serial;
        heap_.push_back(uint64_t{ordered(entry.rect.nearness)} << 32 | ~serial);
        std::push_heap(heap_.begin(), heap_.end());
    }

    Pending pop() {
        SIGHTLINE_DEBUG_ASSERT(!heap_.empty());
        std::pop_heap(heap_.begin(), heap_.end());
        const uint32_t serial = ~static_cast<uint32_t>(heap_.back());
        heap_.pop_back();
        SIGHTLINE_DEBUG_ASSERT(serial < entries_.size() && entries_[serial].serial == serial);
        return entries_[serial];
    }

private:
    /// Orders as the floats do; both zeros are one.
    static uint32_t ordered(float nearness) {
        const uint32_t bits = std::bit_cast<uint32_t>(nearness + 0.0f);
        return bits >> 31 ? ~bits : bits | 0x80000000u;
    }

    Array<Pending> entries_;  // by serial; those that were popped, too
    Array<uint64_t> heap_;    // keys alone: small to move
};

}  // namespace sightline::detail
