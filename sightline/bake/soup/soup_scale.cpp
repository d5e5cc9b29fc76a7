// The size of a scene without marks, how narrow its holes may be, and its opaque triangles.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::bake {

std::optional<SoupScale> soupScaleOf(const Scene& scene, double smallest_hole) {
    SoupScale out;
    out.bounds = worldBounds(scene);
    out.diagonal = out.bounds.empty() ? 0 : glm::length(out.bounds.size());
    if (!(out.diagonal > 0) || !std::isfinite(out.diagonal)) return std::nullopt;
    const double narrow = smallest_hole >= 0 ? smallest_hole : out.diagonal * 0x1p-23;
    // Far from the origin rounding moves planes by more than what the scene's size says.
    const glm::dvec3 far = glm::max(glm::abs(out.bounds.min), glm::abs(out.bounds.max));
    out.hole = std::max({narrow, out.diagonal * 0x1p-30, std::max({far.x, far.y, far.z}) * 0x1p-40});
    return out;
}

std::vector<WallTriangle> opaqueTriangles(const Scene& scene, std::span<const uint32_t> movable) {
    const Box3d everywhere{glm::dvec3(-std::numeric_limits<double>::infinity()),
                           glm::dvec3(std::numeric_limits<double>::infinity())};
    std::vector<WallTriangle> triangles;
    OpaqueWalls(scene, movable).gather(everywhere, triangles);
    return triangles;
}

}  // namespace sightline::bake
