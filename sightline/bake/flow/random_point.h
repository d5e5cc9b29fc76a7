// A seeded random point of a convex polygon.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "sightline/base/random.h"

namespace sightline::bake {

/// Uniform by area: in a triangle of the polygon's fan.
/// @param outline  [size: 3 or more]
inline glm::dvec3 randomPoint(std::span<const glm::dvec3> outline, Random& random) {
    const auto area = [&](size_t i) {
        return glm::length(glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]));
    };
    double total = 0;
    for (size_t i = 1; i + 1 < outline.size(); ++i) total += area(i);
    double chosen = random.uniform() * total;
    size_t i = 1;
    for (; i + 2 < outline.size(); ++i)
        if ((chosen -= area(i)) < 0) break;
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return outline[0] + u * (outline[i] - outline[0]) + v * (outline[i + 1] - outline[0]);
}

}  // namespace sightline::bake
