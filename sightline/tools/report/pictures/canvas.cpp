// Draws shapes by how far each pixel's middle lies from them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::tools {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

/// @param distance  of a place from the shape, below zero inside  [pixels]
template <class Distance>
void Canvas::blend(const glm::dvec2& low, const glm::dvec2& high, Rgb colour, double opacity,
                   const Distance& distance) {
    if (!(low.x > -1e9 && low.y > -1e9 && high.x < 1e9 && high.y < 1e9)) return;
    const auto first = [](double v) { return static_cast<uint32_t>(std::max(std::floor(v) - 1, 0.0)); };
    const auto end = [](double v, uint32_t size) {
        return static_cast<uint32_t>(std::clamp(std::ceil(v) + 1, 0.0, double(size)));
    };
    for (uint32_t y = first(low.y); y < end(high.y, image_.height); ++y)
        for (uint32_t x = first(low.x); x < end(high.x, image_.width); ++x) {
            const double part = opacity * std::clamp(0.5 - distance(glm::dvec2(x + 0.5, y + 0.5)), 0.0, 1.0);
            if (!(part > 0)) continue;
            Rgb& pixel = image_.at(x, y);
            pixel = Rgb(glm::dvec3(pixel) * (1 - part) + glm::dvec3(colour) * part + 0.5);
        }
}

void Canvas::line(const glm::dvec2& from, const glm::dvec2& to, double width, Rgb colour, double opacity) {
    const double radius = width / 2;
    const glm::dvec2 along = to - from;
    const double square = glm::dot(along, along);
    blend(glm::min(from, to) - radius, glm::max(from, to) + radius, colour, opacity, [&](const glm::dvec2& p) {
        const double at = square > 0 ? std::clamp(glm::dot(p - from, along) / square, 0.0, 1.0) : 0.0;
        return glm::length(p - from - at * along) - radius;
    });
}

void Canvas::disc(const glm::dvec2& middle, double radius, Rgb colour, double opacity) {
    blend(middle - radius, middle + radius, colour, opacity,
          [&](const glm::dvec2& p) { return glm::length(p - middle) - radius; });
}

void Canvas::fill(std::span<const glm::dvec2> outline, Rgb colour, double opacity) {
    double area = 0;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (size_t i = 0; i < outline.size(); ++i) {
        low = glm::min(low, outline[i]);
        high = glm::max(high, outline[i]);
        if (i >= 2) area += cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    }
    if (area == 0 || !std::isfinite(area)) return;
    const double turn = area > 0 ? 1 : -1;
    blend(low, high, colour, opacity, [&](const glm::dvec2& p) {
        double worst = -std::numeric_limits<double>::infinity();
        for (size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec2 edge = outline[(i + 1) % outline.size()] - outline[i];
            const double length = glm::length(edge);
            if (length > 0) worst = std::max(worst, -turn * cross(edge, p - outline[i]) / length);
        }
        return worst;
    });
}

std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
    std::sort(points.begin(), points.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<glm::dvec2> hull;
    const auto add = [&](const glm::dvec2& p, size_t keep) {
        while (hull.size() >= keep + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const glm::dvec2& p : points) add(p, 0);
    const size_t lower = hull.size();
    for (size_t i = points.size(); i-- > 1;) add(points[i - 1], lower - 1);
    if (points.size() > 1) hull.pop_back();
    return hull;
}

void cutOutline(std::vector<glm::dvec2>& outline, const glm::dvec3& line) {
    std::vector<glm::dvec2> left;
    const auto at = [&](const glm::dvec2& p) { return line.x * p.x + line.y * p.y + line.z; };
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        if (at(a) >= 0) left.push_back(a);
        if ((at(a) >= 0) != (at(b) >= 0)) left.push_back(a + at(a) / (at(a) - at(b)) * (b - a));
    }
    outline.swap(left);
}

}  // namespace sightline::tools
