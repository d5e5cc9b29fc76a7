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

/// Whether four finite points lie in one plane. True only if they do; false also if their coordinates are so far apart
/// in size that a double cannot hold their differences.
bool areCoplanar(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

}  // namespace sightline
