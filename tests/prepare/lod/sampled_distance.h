// The distance of two surfaces from dense samples: every sample of one is held against every triangle of the other.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"

namespace sightline::test {

/// The distance of two surfaces is in [least, most], but for rounding.
struct SampledDistance {
    double least = 0, most = 0;
};

inline double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const double squared = glm::dot(b - a, b - a);
    const double share = squared > 0 ? std::clamp(glm::dot(p - a, b - a) / squared, 0.0, 1.0) : 0.0;
    return glm::distance(p, glm::mix(a, b, share));
}

/// To the plane where the point is over the triangle, else to the nearest side.
inline double distanceToTriangle(const glm::dvec3& p, const glm::dvec3 (&t)[3]) {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) least = std::min(least, distanceToSegment(p, t[k], t[(k + 1) % 3]));
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double area = glm::length(normal);
    if (!(area > 0)) return least;
    for (int k = 0; k < 3; ++k)
        if (glm::dot(normal, glm::cross(t[(k + 1) % 3] - t[k], p - t[k])) < 0) return least;
    return std::min(least, std::abs(glm::dot(normal, p - t[0])) / area);
}

inline double distanceToMesh(const glm::dvec3& p, const MeshView& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
        least = std::min(least, distanceToTriangle(p, {glm::dvec3(mesh.positions[mesh.indices[i]]),
                                                       glm::dvec3(mesh.positions[mesh.indices[i + 1]]),
                                                       glm::dvec3(mesh.positions[mesh.indices[i + 2]])}));
    return least;
}

/// Of the points of one surface from the other one: each side of a triangle is divided by `parts`.
inline SampledDistance sampleOneWay(const MeshView& from, const MeshView& to, int parts) {
    SampledDistance out;
    for (size_t i = 0; i < from.indices.size(); i += 3) {
        const glm::dvec3 t[3] = {glm::dvec3(from.positions[from.indices[i]]),
                                 glm::dvec3(from.positions[from.indices[i + 1]]),
                                 glm::dvec3(from.positions[from.indices[i + 2]])};
        double longest = 0, least = 0;
        for (int k = 0; k < 3; ++k) longest = std::max(longest, glm::distance(t[k], t[(k + 1) % 3]));
        for (int u = 0; u <= parts; ++u)
            for (int v = 0; u + v <= parts; ++v) {
                const glm::dvec3 p =
                    (double(u) * t[0] + double(v) * t[1] + double(parts - u - v) * t[2]) / double(parts);
                least = std::max(least, distanceToMesh(p, to));
            }
        out.least = std::max(out.least, least);
        out.most = std::max(out.most, least + longest / parts);  // no point is farther from a sample
    }
    return out;
}

inline SampledDistance sampleDistance(const MeshView& a, const MeshView& b, int parts) {
    const SampledDistance there = sampleOneWay(a, b, parts), back = sampleOneWay(b, a, parts);
    return {std::max(there.least, back.least), std::max(there.most, back.most)};
}

}  // namespace sightline::test
