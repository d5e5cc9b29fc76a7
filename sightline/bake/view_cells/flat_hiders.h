// The large flat parts of a scene's opaque surfaces, as convex polygons that hide what is behind them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/soup/soup_walls.h"
#include "sightline/base/jobs.h"
#include "sightline/math/box.h"

namespace sightline::bake {

/// A convex polygon that opaque fronts cover wholly: a segment that comes from in front of its plane and goes behind it
/// through the polygon meets one of them within `bend` of the plane, which is the rounding of its coarsest wall.
struct FlatHider {
    glm::dvec4 plane{0.0};            ///< its normal has length 1 and points to where it hides from
    std::vector<glm::dvec3> corners;  ///< counter-clockwise as seen from there
    Box3d bounds;                     ///< of the corners
    double area = 0;
    double bend = 0;                ///< [world units] [> 0]
    double hole = 0;                ///< the rounding of its finest wall  [world units] [> 0]
    std::vector<uint32_t> objects;  ///< whose triangles cover it, rising  [Scene::objects]
};

struct FlatHiderSettings {
    double least_area = 0;       ///< smaller ones are left out  [world units^2]
    uint32_t most_of_part = 16;  ///< rectangles of one part that hangs together
    Jobs* jobs = nullptr;        ///< threads to share the sheets out to; the answer is the same with any
};

/// Of each side of a sheet, part by part: its hull if that is covered and has few corners, else the largest rectangles
/// along the lines of its edges, which may overlap. What is left uncovered costs tightness alone. Gaps narrower than
/// a third of the roundings of the walls beside them count as covered, as those of cellsOfSoup() do. Deterministic.
std::vector<FlatHider> flatHiders(const SoupWalls& walls, const FlatHiderSettings& settings);

}  // namespace sightline::bake
