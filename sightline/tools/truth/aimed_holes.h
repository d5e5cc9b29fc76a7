// Holes to aim segments through: outlines in one array, and points in them.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"

namespace sightline::tools {

struct AimedHoles {
    std::vector<glm::dvec3> points;
    std::vector<uint32_t> first{0};  ///< where a hole's outline begins, and where the last one's ends

    size_t size() const { return first.size() - 1; }
    std::span<const glm::dvec3> outline(size_t i) const { return {points.data() + first[i], first[i + 1] - first[i]}; }
    /// @param outline  convex  [size: 3 or more]
    void add(std::span<const glm::dvec3> outline) {
        points.insert(points.end(), outline.begin(), outline.end());
        first.push_back(static_cast<uint32_t>(points.size()));
    }
};

/// In a triangle between three of the corners: of thin outlines, too, anywhere along them.
inline glm::dvec3 pointInHole(Random& random, std::span<const glm::dvec3> outline) {
    const size_t i = 1 + random.below(outline.size() - 2);
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return outline[0] + u * (outline[i] - outline[0]) + v * (outline[i + 1] - outline[0]);
}

/// Uniform on the unit sphere.
inline glm::dvec3 randomDirection(Random& random) {
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 6.283185307179586);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace sightline::tools
