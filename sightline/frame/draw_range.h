// A run of an object's triangles of which some may be seen.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// Triangles of a kept object that has clusters: what of it may be seen.
struct DrawRange {
    uint32_t object = 0;            ///< index into VisibleSet::objects
    uint32_t first = 0, count = 0;  ///< in the order of DrawClusters::triangles
    uint32_t part = 0;              ///< DrawClusters::part
};

}  // namespace sightline
