// The size of a scene without marks, and its opaque triangles with how narrow holes beside them may be.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_scale.h"

#include <algorithm>
#include <cmath>

namespace sightline::bake {

namespace {

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

std::optional<SoupScale> soupScaleOf(const Scene& scene) {
    SoupScale out;
    out.bounds = worldBounds(scene);
    out.core = coreOf(scene);
    out.diagonal = out.core.diagonal();
    if (!(out.diagonal > 0) || !out.bounds.finite()) return std::nullopt;
    return out;
}

std::vector<WallTriangle> opaqueTriangles(const Scene& scene, const SoupScale& scale, double smallest_hole,
                                          std::span<const uint32_t> movable) {
    std::vector<WallTriangle> triangles;
    OpaqueWalls(scene, movable).gather(scale.core.bounds, triangles);
    std::erase_if(triangles, [&](const WallTriangle& triangle) {
        Box3d box;
        for (const glm::dvec3& corner : triangle.corners) box.grow(corner);
        return !scale.core.bounds.holds(box);
    });
    const glm::dvec3 middle = scale.core.bounds.center();
    for (WallTriangle& triangle : triangles) {
        // Planes are computed in doubles of the triangle's own coordinates, and are off by far less than 2^13 roundings of
        // 2^-53. Of the core's size only the rounding counts: faces of cells are cut from squares of some diagonals.
        double least = 0x1p-48 * scale.diagonal;
        for (const glm::dvec3& corner : triangle.corners) least = std::max(least, 0x1p-40 * largest(corner));
        // An object's place was rounded, too. What all places share, as on a map, is in doubles and counts for nothing.
        const glm::dvec3 at(scene.objects[triangle.object].transform[3]);
        const double moved = std::min(largest(at), largest(at - middle));
        const double own = triangle.rounding + 0x1p-22 * moved;
        triangle.rounding = std::max(smallest_hole >= 0 ? smallest_hole : own, least);
    }
    return triangles;
}

double largestHole(std::span<const WallTriangle> triangles) {
    double largest = 0;
    for (const WallTriangle& triangle : triangles) largest = std::max(largest, triangle.rounding);
    return largest;
}

}  // namespace sightline::bake
