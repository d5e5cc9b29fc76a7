// A range of places in the hierarchy: the leaves below a node stand side by side.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/assert.h"
#include "sightline/tree/bvh.h"

namespace sightline::detail {

struct PlaceRange {
    uint32_t first = 0, count = 1;
    uint32_t empty = 0;  ///< of them, those that hold no object

    bool holds(uint32_t place) const { return place >= first && place - first < count; }
};

inline PlaceRange placesBelow(const BvhNode& node, int slot) {
    SIGHTLINE_DEBUG_ASSERT(slot >= 0 && slot < 8 && node.count[slot] > 0 && node.empty[slot] < node.count[slot]);
    return {node.first[slot], node.count[slot], node.empty[slot]};
}

}  // namespace sightline::detail
