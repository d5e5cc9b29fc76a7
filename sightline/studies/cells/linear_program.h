// Whether half-planes, or half-spaces, have a point in common within a box: in doubt they have.
// SPDX-License-Identifier: MIT
//
// Raimund Seidel. Small-Dimensional Linear Programming and Convex Hulls Made Easy. 1991.
// Gyula Farkas. Theorie der einfachen Ungleichungen. 1902.
#pragma once

#include <span>

#include <glm/glm.hpp>

namespace sightline::studies {

/// A point that is in all half-planes, dot(line, (p, 1)) >= 0, and in a rectangle.
///
/// Incremental, as Seidel's: a point is kept, and where a new half-plane lacks it, looked for again on its edge alone. In
/// the middle of what is left there, and not at an end: so most of what comes later keeps it. O(n) if nothing moves it,
/// O(n^2) at worst. That there is none is said only with weights, not negative, that make a sum of three of the half-planes
/// negative in the whole rectangle, whatever rounding made of the weights and of the sum. So false is certain, and true is
/// not: the point may be off by rounding.
/// @param lines  of any length  [finite]
/// @param low    of the rectangle  [finite, <= high]
/// @param point  where to begin: a point found for some of the lines saves work; receives the point
bool commonPoint(std::span<const glm::dvec3> lines, const glm::dvec2& low, const glm::dvec2& high, glm::dvec2& point);

/// The same in space: half-spaces and a box, and sums of four. O(n^3) at worst.
bool commonPoint(std::span<const glm::dvec4> planes, const glm::dvec3& low, const glm::dvec3& high, glm::dvec3& point);

}  // namespace sightline::studies
