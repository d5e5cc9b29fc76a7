// The size of a scene without marks, how narrow its holes may be, and its opaque triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sightline/bake/marked/opaque_walls.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

struct SoupScale {
    Box3d bounds;         ///< of the scene
    double diagonal = 0;  ///< of the bounds
    double hole = 0;      ///< narrower holes are none; never less than rounding asks for  [world units] [> 0]
};

/// None of a scene without a size.
/// @param smallest_hole  SoupCellSettings::smallest_hole
std::optional<SoupScale> soupScaleOf(const Scene& scene, double smallest_hole);

/// All that OpaqueWalls finds.
std::vector<WallTriangle> opaqueTriangles(const Scene& scene, std::span<const uint32_t> movable);

}  // namespace sightline::bake
