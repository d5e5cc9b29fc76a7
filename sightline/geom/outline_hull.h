// The convex hull of points in a plane.
// SPDX-License-Identifier: MIT
//
// A. M. Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. 1979.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline {

/// Corners of the hull of points that lie in one plane, or nearly: some of the points, as they are. Counter-clockwise
/// as seen from the normal's tip; points that lie on its edges are left out. Fewer than three if the points lie on a
/// line. O(n log n).
/// @param normal  of the plane; not zero
std::vector<glm::dvec3> outlineHull(std::span<const glm::dvec3> points, const glm::dvec3& normal);

}  // namespace sightline
