// Joins small objects that are near one another: where a draw call costs more than what it draws.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

struct MergeSmall {
    uint32_t triangles = 64;  ///< objects with fewer are small
    uint32_t cubes = 16;  ///< of a grid over the scene, along its longest side: small objects of one cube are joined
};

/// What was joined, and into what.
struct MergedScene {
    Scene scene;
    uint64_t small = 0;   ///< objects that are in joined ones now
    uint64_t joined = 0;  ///< objects that hold them
};

/// The same triangles with the same materials in the same places, to a float's rounding near each cube. Joined objects
/// come behind those that stay, with keys of their own. What deforms, what shuts a portal, what has no finite place, and
/// what is alone in its cube stays as it is.
MergedScene mergeSmall(Scene scene, const MergeSmall& settings = {});

}  // namespace sightline::tools
