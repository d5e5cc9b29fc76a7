// Which side of a triangle is seen: against the eye, on the screen, and in homogeneous space.
// SPDX-License-Identifier: MIT
//
// Marc Olano, Trey Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997 (the determinant).
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/geom/front_face.h"

namespace sightline::studies {

/// How a back face is known. All agree but for rounding; the names are where the test is made.
enum class FacingTest : uint8_t {
    kHomogeneous,  ///< the determinant of (x, y, w): before clipping, whatever the signs of w
    kEyePlane,     ///< the triangle's plane and the eye, or the direction of view
    kScreenArea,   ///< the signed area on the screen: after clipping, since without w > 0 it means nothing
};

// All of these are positive for a front face that is counter-clockwise, negative for its back, and 0 for what is seen
// edge-on or has no area, which is never drawn. A mirroring transform turns about the winding of what it moves, and
// so turns these signs: of all but the test in object space, where nothing has been mirrored.

/// (v1 - v0) x (v2 - v0): towards the side from which the triangle is counter-clockwise. Not of unit length.
inline glm::dvec3 faceNormal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a);
}

/// The eye in the plane's equation, n * e + d.
inline double eyeFacing(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& eye) {
    return glm::dot(faceNormal(a, b, c), eye - a);
}

/// Parallel views: a face whose normal goes along with the direction of view is a back face.
inline double parallelFacing(const glm::dvec3& normal, const glm::dvec3& forward) { return -glm::dot(normal, forward); }

/// Twice the signed area of a triangle, y up. Of use only if its corners had w > 0.
inline double screenFacing(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// The same for a polygon.
inline double screenFacing(std::span<const glm::dvec2> polygon) {
    double sum = 0;
    for (size_t i = 2; i < polygon.size(); ++i) sum += screenFacing(polygon[0], polygon[i - 1], polygon[i]);
    return sum;
}

/// Six times the signed volume of eye and triangle in (x, y, w), whether or not the triangle crosses the eye's plane.
/// @param normal  of the triangle in that space
inline double homogeneousFacing(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c, glm::dvec3& normal) {
    const glm::dvec3 p(a.x, a.y, a.w);
    const glm::dvec3 q(b.x, b.y, b.w);
    const glm::dvec3 r(c.x, c.y, c.w);
    normal = glm::cross(q - p, r - p);
    return glm::dot(normal, p);
}

/// The eye of a perspective view in an item's own space: one transform a mesh instead of one a vertex, and
/// eyeFacing() there needs no turning about for mirrored items.
/// @param transform  affine, object to world, invertible
inline glm::dvec3 eyeInObject(const glm::dmat4& transform, const glm::dvec3& eye) {
    return glm::inverse(glm::dmat3(transform)) * (eye - glm::dvec3(transform[3]));
}

/// The direction of a parallel view in an item's own space. Its length is of no meaning.
inline glm::dvec3 directionInObject(const glm::dmat4& transform, const glm::dvec3& forward) {
    return glm::inverse(glm::dmat3(transform)) * forward;
}

}  // namespace sightline::studies
