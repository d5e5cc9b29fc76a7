// The size of a scene without marks, and its opaque triangles with how narrow holes beside them may be.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sightline/bake/marked/opaque_walls.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::bake {
using namespace tools;

struct SoupScale {
    Box3d bounds;         ///< of the scene
    SceneCore core;       ///< of it; what is left aside is no wall
    double diagonal = 0;  ///< of the core
};

/// None of a scene without a size.
std::optional<SoupScale> soupScaleOf(const Scene& scene);

/// What OpaqueWalls finds within the core. No hole beside a triangle is narrower than its `rounding`, which is never less
/// than what the arithmetic asks for.
/// @param smallest_hole  SoupCellSettings::smallest_hole
std::vector<WallTriangle> opaqueTriangles(const Scene& scene, const SoupScale& scale, double smallest_hole,
                                          std::span<const uint32_t> movable);

/// The largest rounding.
double largestHole(std::span<const WallTriangle> triangles);

}  // namespace sightline::bake
