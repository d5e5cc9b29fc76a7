// Whether a plane parts two convex things that may touch, and whether triangles meet, by exact predicates.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <glm/glm.hpp>

namespace sightline {

/// Whether some plane has all points of one hull on it or on one side of it, all of the other on it or on the other
/// side, and not all of both on it. Then no point in the inside of one hull lies in the other.
///
/// True only if there is such a plane. It is found if there is one and the points do not all lie in a plane: of the
/// planes that part two hulls, those that cannot be turned any further pass through three of their corners.
///
/// @param a, b  corners of two hulls; corners in common are equal  [limit: 4 each]
bool areParted(std::span<const glm::vec3> a, std::span<const glm::vec3> b);

/// Whether two triangles meet in nothing but the corners that they have in common, and the side between two of those.
/// True only if they do; false also in rare cases of doubt.
bool meetInCornersOnly(const glm::vec3 (&a)[3], const glm::vec3 (&b)[3]);

}  // namespace sightline
