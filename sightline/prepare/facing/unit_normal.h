// The direction in which a triangle faces, or the word that rounding hides it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace sightline {

/// No component of a unitNormal() is farther from the true one.
inline constexpr double kNormalError = 0x1p-29;

/// Of unit length, towards where the triangle is counter-clockwise from, or 0 if it has no area, hardly any for the length
/// of its sides, or a corner that is not finite.
inline glm::dvec3 unitNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 u = glm::dvec3(b) - glm::dvec3(a), v = glm::dvec3(c) - glm::dvec3(a);
    const glm::dvec3 n = glm::cross(u, v);
    const double length = glm::length(n);
    // The cross product is off by 2^-50 of |u||v| at most. This leaves out angles below 2^-20.
    const double limit = 0x1p-20 * glm::length(u) * glm::length(v);
    if (!(length > limit) || !(length < 1e300)) return glm::dvec3(0.0);
    return n / length;
}

}  // namespace sightline
