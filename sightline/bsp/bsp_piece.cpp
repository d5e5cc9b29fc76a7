// One polygon and one plane: which plane a polygon has, on which side of another it lies, and its two parts.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/bsp_piece.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/exact_product.h"
#include "sightline/math/finite.h"

namespace sightline {
namespace {

glm::dvec3 accurateCross(const glm::dvec3& a, const glm::dvec3& b) {
    return {differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
            differenceOfProducts(a.x, b.y, a.y, b.x)};
}

/// From the back end to the front one, whatever the direction of the edge.
/// @param uncertainty  grows to how far the crossing may be off
glm::dvec3 crossing(const BspLine& line, const glm::dvec4& plane, double rounding, double& uncertainty) {
    const double from = distanceTo(plane, line.from), to = distanceTo(plane, line.to);
    const double low = from < to ? from : to, high = from < to ? to : from;
    const glm::dvec3 &back = from < to ? line.from : line.to, &front = from < to ? line.to : line.from;
    uncertainty = std::max(uncertainty, glm::length(front - back) * (rounding / (high - low)));
    return back + low / (low - high) * (front - back);
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

double splitPolygon(std::span<const glm::dvec3> outline, std::span<const uint32_t> lines, std::vector<BspLine>& all,
                    const glm::dvec4& plane, double thickness, double rounding, BspOutline& back, BspOutline& front) {
    back.clear();
    front.clear();
    const auto push = [](BspOutline& part, const glm::dvec3& point, uint32_t line) {
        part.points.push_back(point);
        part.lines.push_back(line);
    };
    const auto placeOf = [&](const glm::dvec3& p) {
        const double d = distanceTo(plane, p);
        return d > thickness ? 1 : d < -thickness ? -1 : 0;
    };
    const uint32_t seam = static_cast<uint32_t>(all.size());
    double uncertainty = 0;
    int place = placeOf(outline[0]);
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[i + 1 < outline.size() ? i + 1 : 0];
        const int next = placeOf(b);
        // From a point in the plane, one of the parts goes on along the seam.
        if (place <= 0) push(back, a, place == 0 && next > 0 ? seam : lines[i]);
        if (place >= 0) push(front, a, place == 0 && next < 0 ? seam : lines[i]);
        if (place * next < 0) {
            const BspLine& line = all[lines[i]];
            const bool apart = placeOf(line.from) * placeOf(line.to) < 0;
            const glm::dvec3 at = crossing(apart ? line : BspLine{a, b}, plane, rounding, uncertainty);
            push(back, at, place < 0 ? seam : lines[i]);
            push(front, at, place < 0 ? lines[i] : seam);
        }
        place = next;
    }
    BspLine line{back.points[0], back.points[0]};
    for (size_t i = 0; i < back.points.size(); ++i)
        if (back.lines[i] == seam) line = {back.points[i], back.points[i + 1 < back.points.size() ? i + 1 : 0]};
    all.push_back(line);
    return uncertainty;
}

double splitPolygon(std::span<const glm::dvec3> outline, const glm::dvec4& plane, double thickness, double rounding,
                    BspOutline& back, BspOutline& front) {
    std::vector<BspLine> all;
    std::vector<uint32_t> lines;
    for (size_t i = 0; i < outline.size(); ++i) {
        lines.push_back(static_cast<uint32_t>(i));
        all.push_back({outline[i], outline[i + 1 < outline.size() ? i + 1 : 0]});
    }
    return splitPolygon(outline, lines, all, plane, thickness, rounding, back, front);
}

}  // namespace sightline
