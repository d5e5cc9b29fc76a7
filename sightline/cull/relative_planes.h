// The planes of a frustum in float, for boxes around an origin.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/geom/frustum.h"

namespace sightline {

/// The planes of a frustum in float, for boxes around an origin.
struct RelativePlanes {
    float normal[6][3];
    float distance[6];  ///< with a margin for all rounding up to `reach`
    uint32_t count = 0;
};

/// @param reach  no bound that is tested is farther from the origin on any axis  [world units]
RelativePlanes relativePlanes(const Frustum& frustum, const glm::dvec3& origin, float reach);

}  // namespace sightline
