// One polygon and one plane: which plane a polygon has, on which side of another it lies, and its two parts.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sightline {

inline double distanceTo(const glm::dvec4& plane, const glm::dvec3& p) {
    return plane.x * p.x + plane.y * p.y + (plane.z * p.z + plane.w);
}

/// The plane of a flat polygon, counter-clockwise seen from its front; unit normal. Slivers have as good a plane as any:
/// cross products are computed as if with twice the digits.
/// @returns nothing if all points lie on a line, or some are not finite
std::optional<glm::dvec4> planeOf(std::span<const glm::dvec3> outline);

/// Where a polygon reaches beyond a plane's thickness. Neither: it lies in the plane. Both: it is to be split.
struct BspReach {
    bool back = false, front = false;
};
BspReach reachOf(std::span<const glm::dvec3> outline, const glm::dvec4& plane, double thickness);

/// The whole of an edge: parts of it are cut as it would be, whatever cut them before.
struct BspLine {
    glm::dvec3 from{0.0}, to{0.0};
};

/// A polygon, or a part of one.
struct BspOutline {
    std::vector<glm::dvec3> points;
    std::vector<uint32_t> lines;  ///< per point: the line of the edge that begins there

    void clear() {
        points.clear();
        lines.clear();
    }
};

/// Parts a polygon that reaches to both sides. Points within the thickness go to both parts as they are. A crossing
/// is computed from the ends of its edge's line, from the back one to the front one.
/// @param lines        per point of the outline: the line of the edge that begins there, an index into all
/// @param all          the line of the edge along which the parts touch is appended
/// @param back, front  the parts, in place of what is there
/// @returns the uncertainty of the crossings, given that of distances: how far along its edge one may be off [world units]
double splitPolygon(std::span<const glm::dvec3> outline, std::span<const uint32_t> lines, std::vector<BspLine>& all,
                    const glm::dvec4& plane, double thickness, double rounding, BspOutline& back, BspOutline& front);

/// The same for a whole polygon.
double splitPolygon(std::span<const glm::dvec3> outline, const glm::dvec4& plane, double thickness, double rounding,
                    BspOutline& back, BspOutline& front);

}  // namespace sightline
