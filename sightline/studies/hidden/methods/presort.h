// Orders what is to be drawn by its depth: near to far for a z-buffer, far to near for a painter.
// SPDX-License-Identifier: MIT
//
// Herman Hollerith. Art of Compiling Statistics. 1889. (Sorting by one digit after the other.)
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

struct SortEntry {
    uint64_t key = 0;
    uint32_t value = 0;
};

/// Bits that rise as the number rises, negative ones and infinities included; both zeros are one.
inline uint64_t sortKey(double number) {
    const uint64_t bits = std::bit_cast<uint64_t>(number + 0.0);
    return bits >> 63 != 0 ? ~bits : bits | 1ull << 63;
}

/// Sorts by rising keys; entries of equal keys keep their order. The bits below those that all keys share are taken
/// thirty-three at a time, digit by digit from the lowest: mostly the first of these settle the order, and the rest
/// looks only at entries that are still equal. O(n). [limit: < 2^32 entries]
/// @param scratch  overwritten; keep it from call to call to save the allocation
void radixSort(std::vector<SortEntry>& entries, std::vector<SortEntry>& scratch);

enum class DepthOrder : uint8_t {
    kNearToFar,  ///< what a z-buffer wants: later fragments fail their test
    kFarToNear,  ///< what a painter wants
};

/// The places of polygons in order of their nearest points (near to far) or of their farthest (far to near). Of equal
/// ones the lower surface comes first near to far, and last far to near: it is the one that stays.
std::vector<uint32_t> orderPolygons(std::span<const ScreenPolygon> polygons, DepthOrder order);

/// The places of a list's items in order of their nearest (or farthest) vertices, by depth in eye space. Items without
/// vertices come as if they were at the eye. O(vertices).
std::vector<uint32_t> orderItems(const DrawList& list, const View& view, DepthOrder order);

}  // namespace sightline::studies
