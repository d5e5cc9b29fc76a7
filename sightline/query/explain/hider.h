// One of the occluders that hide an object.
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

}  // namespace sightline
