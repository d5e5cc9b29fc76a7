// Predicates on positions of meshes whose answers are exact: floats are taken as the numbers that they are.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#pragma once

#include <glm/glm.hpp>

namespace sightline {

/// Whether three finite points lie on one line.
bool areCollinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Whether a point lies on the straight line between two others, and is neither of them.
bool liesBetween(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b);

/// Whether four finite points lie in one plane.
bool areCoplanar(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

/// Where a point lies to the plane through three others, seen from where these run counter-clockwise.
enum class Side : int8_t {
    kBehind = -1,
    kOn = 0,      ///< exactly; also if the three lie on one line
    kBefore = 1,  ///< on the side from which they run counter-clockwise
    kUnsure = 2,  ///< a coordinate is not finite
};
Side sideOf(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace sightline
