// Convex regions: the faces of what half-spaces have in common, and the planes around points.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// A face of a convex region.
struct RegionFace {
    uint32_t plane = 0;               ///< index of the plane that it lies in
    std::vector<glm::dvec3> outline;  ///< counter-clockwise as seen from inside the region
};

struct ConvexRegion {
    enum class Kind : uint8_t { kSolid, kEmpty, kUnbounded };
    Kind kind = Kind::kEmpty;
    std::vector<RegionFace> faces;  ///< planes that only touch the region have none  [of kSolid]
    Box3d bounds;
};

/// The region where dot(plane, (p, 1)) >= 0 for all planes, to within rounding, 2^-36 of its distance from the origin
/// and of its size. What is thinner is empty; what reaches farther than 2^11 times the largest distance of a plane from
/// the origin is unbounded. O(n^2).
/// @param planes  normals of length 1  [finite]
ConvexRegion convexRegion(std::span<const glm::dvec4> planes);

/// The part of a convex polygon where dot(plane, (p, 1)) >= 0, to within rounding; empty if nothing is left.
std::vector<glm::dvec3> clipOutline(std::span<const glm::dvec3> outline, const glm::dvec4& plane);

/// Planes around points, inward and of unit length: of their convex hull. None if they lie in a plane, to within 2^-30 of their
/// extent, or are not finite. O(n^4): for the corners of a room, not for meshes.
/// @param points  [limit: 64 or fewer]
std::vector<glm::dvec4> planesAround(std::span<const glm::dvec3> points);

/// The six planes of a box, inward.
std::vector<glm::dvec4> planesOfBox(const Box3d& box);

}  // namespace sightline
