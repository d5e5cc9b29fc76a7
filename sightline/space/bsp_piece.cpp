// One polygon and one plane: which plane a polygon has, on which side of another it lies, and its two parts.
// SPDX-License-Identifier: MIT
#include "sightline/space/bsp_piece.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

/// a * b - c * d, right to within two units in the last place even where the products cancel (William Kahan).
double differenceOfProducts(double a, double b, double c, double d) {
    const double cd = c * d;
    const double error = std::fma(-c, d, cd);
    return std::fma(a, b, -cd) + error;
}

glm::dvec3 accurateCross(const glm::dvec3& a, const glm::dvec3& b) {
    return {differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
            differenceOfProducts(a.x, b.y, a.y, b.x)};
}

bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// From the back end to the front one, whatever the direction of the edge.
glm::dvec3 crossing(const glm::dvec3& back, double below, const glm::dvec3& front, double above) {
    const double t = below / (below - above);
    return back + t * (front - back);
}

}  // namespace

std::optional<glm::dvec4> planeOf(std::span<const glm::dvec3> outline) {
    if (outline.size() < 3) return std::nullopt;
    for (const glm::dvec3& p : outline)
        if (!isFinite(p)) return std::nullopt;
    glm::dvec3 normal(0.0), mean(0.0);
    if (outline.size() == 3) {
        // The two edges at the corner opposite to the longest side.
        int corner = 0;
        double longest = -1;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 side = outline[(i + 2) % 3] - outline[(i + 1) % 3];
            if (const double length = glm::dot(side, side); length > longest) {
                longest = length;
                corner = i;
            }
        }
        const glm::dvec3& at = outline[corner];
        normal = accurateCross(outline[(corner + 1) % 3] - at, outline[(corner + 2) % 3] - at);
    } else {
        for (size_t i = 1; i + 1 < outline.size(); ++i)
            normal += accurateCross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    }
    const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
    normal /= largest;
    normal /= glm::length(normal);
    for (const glm::dvec3& p : outline) mean += p / static_cast<double>(outline.size());
    const glm::dvec4 plane(normal, -glm::dot(normal, mean));
    return std::isfinite(plane.w) && isFinite(normal) ? std::optional(plane) : std::nullopt;
}

BspReach reachOf(std::span<const glm::dvec3> outline, const glm::dvec4& plane, double thickness) {
    double low = distanceTo(plane, outline[0]), high = low;
    for (size_t i = 1; i < outline.size(); ++i) {
        const double d = distanceTo(plane, outline[i]);
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    return {low<-thickness, high> thickness};
}

double splitPolygon(std::span<const glm::dvec3> outline, const glm::dvec4& plane, double thickness, double rounding,
                    std::vector<glm::dvec3>& back, std::vector<glm::dvec3>& front) {
    double uncertainty = 0;
    const auto place = [&](double d) { return d > thickness ? 1 : d < -thickness ? -1 : 0; };
    glm::dvec3 a = outline.back();
    double from = distanceTo(plane, a);
    for (const glm::dvec3& b : outline) {
        const double to = distanceTo(plane, b);
        if (place(from) * place(to) < 0) {
            const glm::dvec3 at = from < 0 ? crossing(a, from, b, to) : crossing(b, to, a, from);
            back.push_back(at);
            front.push_back(at);
            uncertainty = std::max(uncertainty, glm::length(b - a) * (rounding / std::abs(to - from)));
        }
        if (place(to) <= 0) back.push_back(b);
        if (place(to) >= 0) front.push_back(b);
        a = b;
        from = to;
    }
    return uncertainty;
}

}  // namespace sightline
