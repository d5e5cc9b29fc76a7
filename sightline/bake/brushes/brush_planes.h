// The planes of brushes, each once, and the polyhedra that they cut out.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {

/// The signed distance of a point from a plane with a unit normal.
inline double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// The plane through three points as a map has them, its unit normal out of the brush; none if they lie in a line.
std::optional<glm::dvec4> planeThrough(const glm::dvec3 (&points)[3]);

/// Planes that are told apart. Each is kept facing one way; a side is its number times 2, plus 1 if the side faces
/// the other way.
class BrushPlanes {
public:
    /// @param snap_distance  planes whose normals are all but the same (1e-5) are one where a side that takes the other's
    ///                       plane moves no farther than this: at the point nearest to the origin, and at each corner
    ///                       of its face  [world units]
    explicit BrushPlanes(double snap_distance) : snap_(snap_distance) {}

    static constexpr uint32_t kNone = ~0u;

    /// The side in a plane with a unit normal.
    /// @param face  the brush's corners in the plane; none: other sides bound the brush, and it does not grow
    uint32_t sideOf(const glm::dvec4& plane, std::span<const glm::dvec3> face);

    size_t size() const { return planes_.size(); }
    const glm::dvec4& plane(size_t i) const { return planes_[i]; }
    /// Facing as the side does: behind it, dot(plane, (p, 1)) < 0, lies the brush.
    glm::dvec4 planeOf(uint32_t side) const { return (side & 1) != 0 ? -planes_[side >> 1] : planes_[side >> 1]; }

private:
    double snap_;
    std::vector<glm::dvec4> planes_;
    std::unordered_map<int64_t, std::vector<uint32_t>> by_distance_;
};

/// A convex polyhedron as its faces.
struct BrushFace {
    glm::dvec4 plane{0.0};            ///< facing out
    std::vector<glm::dvec3> outline;  ///< counter-clockwise as seen from outside
};

using BrushFaces = std::vector<BrushFace>;

/// What of a large square in a plane lies behind all the others; empty if less than three corners are left.
/// @param box     is held by the square
/// @param others  facing out
std::vector<glm::dvec3> faceIn(const glm::dvec4& plane, const Box3d& box, std::span<const glm::dvec4> others);

/// The six faces of a box.
BrushFaces facesOfBox(const Box3d& box);

/// What of a polyhedron lies behind a plane, and in front of it: by the sign, without a tolerance.
void cutFaces(const BrushFaces& faces, const glm::dvec4& plane, const Box3d& box, BrushFaces& behind,
              BrushFaces& in_front);

}  // namespace sightline::bake
