// What a walk has met and not yet looked at, nearest first.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sightline/base/memory.h"
#include "sightline/cull/occlusion.h"
#include "sightline/run/volumes.h"
#include "sightline/space/bvh.h"

namespace sightline::detail {

/// Places side by side in the hierarchy.
struct PlaceRange {
    uint32_t first = 0, count = 1;
    uint32_t empty = 0;  ///< of them, those that hold no object
};

inline PlaceRange placesBelow(const BvhNode& node, int slot) {
    return {node.first[slot], node.count[slot], node.empty[slot]};
}

/// Something that the walk has met and not yet looked at.
struct Pending {
    enum class Kind : uint8_t { kNode, kObject, kCluster };
    PixelRect rect;
    uint32_t serial = 0;  ///< how many were met before it
    uint32_t index = 0;   ///< node; place of the object; or cluster
    uint32_t owner = 0;   ///< of a cluster: index into Walk::instances
    PlaceRange below;     ///< the objects below
    uint32_t planes = 0;  ///< of a node: as Visit has it
    VolumeRange volumes;  ///< of a node: volumes that it crosses
    Kind kind = Kind::kNode;
    bool testable = false;  ///< the rectangle stands for the bound; else it is in doubt, or outside and kept
};

/// Gives back what was put in by its nearness, the greatest first; equals in the order in which they were met.
class PendingQueue {
public:
    explicit PendingQueue(Memory* memory) : met_(memory), line_(memory) {}

    bool empty() const { return line_.empty(); }
    void clear() {
        met_.clear();
        line_.clear();
    }

    void push(const Pending& entry) {
        const uint32_t serial = static_cast<uint32_t>(met_.size());
        met_.push_back(entry);
        met_.back().serial = serial;
        line_.push_back(uint64_t{ordered(entry.rect.nearness)} << 32 | ~serial);
        std::push_heap(line_.begin(), line_.end());
    }

    Pending pop() {
        std::pop_heap(line_.begin(), line_.end());
        const uint32_t serial = ~static_cast<uint32_t>(line_.back());
        line_.pop_back();
        return met_[serial];
    }

private:
    /// Orders as the floats do; both zeros are one.
    static uint32_t ordered(float nearness) {
        const uint32_t bits = std::bit_cast<uint32_t>(nearness + 0.0f);
        return bits >> 31 ? ~bits : bits | 0x80000000u;
    }

    Array<Pending> met_;    // by serial; also those that have been taken
    Array<uint64_t> line_;  // a heap; a few bytes each, as they are moved about
};

}  // namespace sightline::detail
