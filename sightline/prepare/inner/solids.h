// Finds the closed surfaces among triangles: those of which it is certain what lies inside.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline {

/// A triangle by its vertices, counter-clockwise seen from outside.
struct SolidTriangle {
    uint32_t vertex[3];
};

/// Triangles that bound a solid, from outside: each side is shared with exactly one other triangle, which runs along it
/// the other way; no two triangles meet elsewhere than in common corners and sides; the whole hangs together and has a
/// volume. So each point of space that is not on the surface is either inside, and a ray from there to infinity leaves
/// the surface once more than it enters, or outside.
struct Solid {
    std::vector<uint32_t> triangles;  ///< by the list given
};

/// Exact: what is not surely a solid is not reported. O(n log n) for what is built; a region in which very many
/// triangles lie close together is given up.
std::vector<Solid> findSolids(std::span<const glm::vec3> positions, std::span<const SolidTriangle> triangles);

}  // namespace sightline
