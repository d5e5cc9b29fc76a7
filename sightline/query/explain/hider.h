// One of the occluders that hide an object, and what of it does.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/world/world_object.h"

namespace sightline {

struct Hider {
    ObjectId id;
    uint64_t key = 0;
    double share = 0;  ///< of the object's rectangle: pixels that it is the nearest to cover. All shares add up to 1
};

/// A part of an occluder that hides by itself: one of its flat faces, or a convex body of several.
struct HiderOutline {
    Visible object;
    uint32_t first = 0, count = 0;  ///< its corners, in turn: a convex outline as the eye sees it
};

}  // namespace sightline
