// The opaque triangles of a scene by the planes that they lie in: what may divide space where nobody marked cells.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/marked/opaque_walls.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// Triangles that lie in one plane.
struct WallSheet {
    glm::dvec4 plane{0.0};            ///< its normal has length 1
    std::vector<uint32_t> triangles;  ///< of SoupWalls::triangles
    double largest = 0;               ///< area of the largest part of one side that hangs together  [world units^2]
    double rounding = 0;              ///< the largest of its triangles'  [world units]
};

struct SoupWalls {
    std::vector<WallTriangle> triangles;
    std::vector<WallSheet> sheets;  ///< by `largest`, the largest first
    std::vector<double>
        part;  ///< per triangle: area of the part of its sheet's side that it belongs to; 0: of no sheet
    uint64_t small_triangles = 0;  ///< of sheets that were left out: nothing of them is large enough
};

/// Sorts triangles into planes. A triangle whose corners lie within half of its rounding of a plane that is nearly parallel
/// to it, and that no coarser triangle gave, may lie in that; which of several, and what is in none, costs tightness alone.
/// Deterministic.
/// @param walls      opaque triangles of the world, their rounding > 0; such without a plane are left out
/// @param least_area sheets with no part of this size that hangs together are left out  [world units^2]
SoupWalls sheetsOf(std::vector<WallTriangle> walls, double least_area);

}  // namespace sightline::bake
