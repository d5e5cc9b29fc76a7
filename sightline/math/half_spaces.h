// Whether half-spaces leave anything of a plane: decided exactly, however thin it is.
// SPDX-License-Identifier: MIT
//
// Eduard Helly. Ueber Mengen konvexer Koerper mit gemeinschaftlichen Punkten. 1923.
// Theodore Motzkin. Beitraege zur Theorie der linearen Ungleichungen. 1936.
#pragma once

#include <span>

#include <glm/glm.hpp>

namespace sightline {

/// Whether some point p of the plane lies strictly inside all half-spaces: dot(inside, (p, 1)) > 0. What is left is then a
/// piece of positive area, if only finitely many half-spaces are asked; false: it has none, though it may be a line or a point.
///
/// Exact for all finite numbers whose products, four factors each, neither overflow nor underflow. O(n^3) for n half-spaces.
/// @param plane  dot(plane, (p, 1)) = 0; the normal need not have length 1, but is not zero
bool openInPlane(const glm::dvec4& plane, std::span<const glm::dvec4> insides);

/// Whether two planes hold the same points, whichever way they face. Exact, as above.
bool samePlane(const glm::dvec4& a, const glm::dvec4& b);

}  // namespace sightline
