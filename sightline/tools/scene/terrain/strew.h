// Strews trees, rocks and farms over a procedural terrain.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"
#include "sightline/tools/scene/terrain/height.h"

namespace sightline::tools::terrain {

inline constexpr uint32_t kMostObjects = 200'000;  ///< that stand on the ground

/// Adds instances of the library, with which the scene's meshes begin, and their nodes. The place of
/// each follows from the seed and the ground alone; where there would be too many, they thin out evenly.
void strew(const HeightField& field, uint64_t seed, Scene& scene);

}  // namespace sightline::tools::terrain
