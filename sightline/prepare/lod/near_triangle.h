// The point of a triangle that is nearest to another point.
// SPDX-License-Identifier: MIT
//
// Christer Ericson. Real-Time Collision Detection, section 5.1.5. 2005.
#pragma once

#include <algorithm>

#include <glm/glm.hpp>

namespace sightline {

/// Corners of a triangle; two or all three may lie in one place, or all on a line.
struct TriangleCorners {
    glm::dvec3 at[3];
};

/// The point of a segment from a that is nearest to what lies `along` * |ab|^2 / `whole` from a on its line.
inline glm::dvec3 onSegment(const glm::dvec3& a, const glm::dvec3& ab, double along, double whole) {
    return whole > 0 ? a + std::clamp(along / whole, 0.0, 1.0) * ab : a;
}

/// Always a point of the triangle, up to the rounding of a weighted mean: its weights are clamped. That it is the
/// nearest one holds up to rounding, which in needles may be much: where their plane is in doubt, their sides are
/// taken.
inline glm::dvec3 nearestPoint(const TriangleCorners& t, const glm::dvec3& p) {
    const glm::dvec3 &a = t.at[0], &b = t.at[1], &c = t.at[2];
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    // Weights of the corners of the point's foot in the plane, times the squared area of a parallelogram.
    const double of_a = d3 * d6 - d5 * d4, of_b = d5 * d2 - d1 * d6, of_c = d1 * d4 - d3 * d2;
    const double sum = of_a + of_b + of_c;
    const bool inside = of_a > 0 && of_b > 0 && of_c > 0;
    glm::dvec3 best(0.0);
    if (inside) {
        best = a + (of_b / sum) * ab + (of_c / sum) * ac;
        if (sum > 1e-8 * glm::dot(ab, ab) * glm::dot(ac, ac)) return best;
    }
    if (!inside) {
        if (of_c <= 0 && d1 > 0 && d3 < 0) return a + d1 / (d1 - d3) * ab;
        if (of_b <= 0 && d2 > 0 && d6 < 0) return a + d2 / (d2 - d6) * ac;
        if (of_a <= 0 && d4 > d3 && d5 > d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    const glm::dvec3 sides[3] = {onSegment(a, ab, d1, d1 - d3), onSegment(a, ac, d2, d2 - d6),
                                 onSegment(b, c - b, d4 - d3, (d4 - d3) + (d5 - d6))};
    double least = inside ? glm::dot(p - best, p - best) : glm::dot(p - sides[0], p - sides[0]);
    if (!inside) best = sides[0];
    for (const glm::dvec3& side : sides)
        if (const double squared = glm::dot(p - side, p - side); squared < least) least = squared, best = side;
    return best;
}

inline double squaredDistance(const TriangleCorners& t, const glm::dvec3& p) {
    const glm::dvec3 away = p - nearestPoint(t, p);
    return glm::dot(away, away);
}

}  // namespace sightline
