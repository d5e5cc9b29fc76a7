// The back faces of a mesh, triangle by triangle: by planes and the eye, and by the corners' places in clip space or on the screen.
// SPDX-License-Identifier: MIT
//
// Marc Olano, Trey Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997 (the determinant).
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997 (the bounds
// on rounding).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/geom/facing_eye.h"
#include "sightline/geom/triangle_planes.h"

namespace sightline::studies {

/// Sets bit i % 8 of back[i / 8] for each triangle that is surely seen from its back or edge-on, clears it for each that
/// may be seen from its front, and returns how many are set. A triangle without area, or of which rounding hides the facing,
/// counts as a front face. Answers are the same on every instruction set.
///
/// @param back  [size: >= ceil(count / 16) * 2; bits beyond the last triangle are cleared]
size_t findBackFaces(const TrianglePlanes& planes, const FacingEye& eye, std::span<uint8_t> back);

/// Vertices in homogeneous coordinates, after the projection and before any clipping or division, as one array per number.
struct HomogeneousVertices {
    std::span<const float> x, y, w;  ///< all of one size
};

/// The same by the sign of the determinant of the corners' (x, y, w), whatever the signs of w. The answer is that of exact
/// arithmetic on the vertices as they are given, or the triangle counts as a front face.
///
/// @param indices   [size: 3 * triangles; each < vertices.x.size()]
/// @param mirrored  the transform from where the winding was meant to here mirrors
/// @param back      [size: >= ceil(triangles / 16) * 2; bits beyond the last triangle are cleared]
size_t findBackFaces(const HomogeneousVertices& vertices, std::span<const uint32_t> indices, FrontFace front,
                     bool mirrored, std::span<uint8_t> back);

/// Vertices on the screen, y up, as one array per number.
struct ScreenVertices {
    std::span<const float> x, y;  ///< all of one size
};

/// The same by the signed area on the screen. Means something only of triangles whose corners all had w > 0.
size_t findBackFaces(const ScreenVertices& vertices, std::span<const uint32_t> indices, FrontFace front, bool mirrored,
                     std::span<uint8_t> back);

}  // namespace sightline::studies
