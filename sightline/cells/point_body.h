// The convex hull of a few points, cut by planes: points alone, without edges or faces.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

namespace sightline {

/// A body is the hull of its points. What a plane leaves of it is the hull of the points that it leaves and of where
/// the segments between any two points cross it: some of these lie inside, and are points too many.
struct PointBody {
    static constexpr uint32_t kMost = 64;

    glm::dvec3 points[kMost];
    uint32_t count = 0;

    std::span<const glm::dvec3> all() const { return {points, count}; }
};

/// Cuts away where dot(plane, (p, 1)) < least.
/// @param out  receives what is left: no points if nothing is
/// @returns false if there was no room: out is then not usable
inline bool cutBody(std::span<const glm::dvec3> body, const glm::dvec4& plane, double least, PointBody& out) {
    double heights[PointBody::kMost];
    out.count = 0;
    if (body.size() > PointBody::kMost) return false;
    for (size_t i = 0; i < body.size(); ++i) {
        heights[i] = glm::dot(glm::dvec3(plane), body[i]) + plane.w - least;
        if (heights[i] >= 0) out.points[out.count++] = body[i];
    }
    if (out.count == 0 || out.count == body.size()) return true;
    for (size_t i = 0; i < body.size(); ++i) {
        if (heights[i] < 0) continue;
        for (size_t k = 0; k < body.size(); ++k) {
            if (heights[k] >= 0) continue;
            if (heights[i] == 0) break;
            if (out.count == PointBody::kMost) return false;
            out.points[out.count++] = body[i] + heights[i] / (heights[i] - heights[k]) * (body[k] - body[i]);
        }
    }
    return true;
}

}  // namespace sightline
