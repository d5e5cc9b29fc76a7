// Pairs triangles that share an edge into convex, nearly flat quadrangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sightline/geom/mesh_view.h"

namespace sightline {

/// A triangle or a pair of them, by mesh vertices. In a quadrangle the triangles are 0 1 2 and 0 2 3.
struct MeshPolygon {
    uint32_t vertex[4];
    uint32_t triangle;  ///< the first one's index
    int corners;        ///< 3 or 4
};

/// Pairs greedily, longest shared edge first: of a rectangle's two triangles that is the diagonal. Vertices are the
/// same where their positions are equal. The fourth corner lies within 1e-4 of the longest side of the plane of the
/// other three. Deterministic; O(n log n).
///
/// @param triangles  which triangles of the mesh to take; indices in range, positions finite and distinct
/// @param kind       per mesh triangle: only triangles of one kind are paired  [size: mesh.triangles(), or empty]
std::vector<MeshPolygon> pairTriangles(const MeshView& mesh, std::span<const uint32_t> triangles,
                                       std::span<const uint8_t> kind);

}  // namespace sightline
