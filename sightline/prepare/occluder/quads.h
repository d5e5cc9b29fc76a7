// Pairs triangles that share a side into convex, nearly flat quadrangles.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Pairs triangles of one mesh greedily, longest shared side first: of a rectangle's triangles that is the diagonal.
/// The fourth corner lies within 1e-4 of the longest side of the plane of the other three; both are double-sided, or
/// neither. Of each mesh, pairs come first, longest shared side first, then what is left. Deterministic; O(n log n).
///
/// @param patchwork  its polygons are triangles, mesh by mesh
void pairTriangles(Patchwork& patchwork);

/// Whether a quadrangle turns left at each corner, seen against the normal: by a thousandth at least, as a sine.
/// @param normal  of length one
bool isConvex(const glm::dvec3 (&corners)[4], const glm::dvec3& normal);

}  // namespace sightline
