// The exact sign of a triple product: on which side of the plane through the origin and two points a third one lies.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <glm/glm.hpp>

namespace sightline::studies {

/// The sign of dot(cross(a, b), c), which is that of the determinant with rows a, b, c: +1, -1, or 0 if the three lie in
/// a plane with the origin. Exact for all finite inputs whose products neither overflow nor underflow.
int tripleProductSign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace sightline::studies
