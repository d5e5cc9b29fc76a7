// The convex hull of a few points, cut by planes: points alone, without edges or faces.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/assert.h"

namespace sightline {

/// A body is the hull of its points. What a plane leaves of it is the hull of the points that it leaves and of where
/// the segments between any two points cross it: where these are many, their own hull is taken.
struct PointBody {
    static constexpr uint32_t kMost = 64;

    glm::dvec3 points[kMost];
    uint32_t count = 0;

    std::span<const glm::dvec3> all() const {
        SIGHTLINE_DEBUG_ASSERT(count <= kMost);
        return {points, count};
    }
};

/// Points of a plane, of which the corners of their hull are kept when they grow many. As outlineHull(), but it takes no
/// memory: a query cuts bodies in each frame.
///
/// A. M. Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. 1979.
class PlanePoints {
public:
    explicit PlanePoints(const glm::dvec3& normal) {
        const glm::dvec3 size = glm::abs(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        u_ = (axis + 1) % 3;
        v_ = (axis + 2) % 3;
    }

    std::span<const glm::dvec3> all() const { return {points_, count_}; }

    /// @returns false if there is no room
    bool add(const glm::dvec3& point) {
        if (count_ == kMost) keepHull();
        if (count_ == kMost) return false;
        points_[count_++] = point;
        return true;
    }

    /// By two chains of the points in the order of u and v.
    void keepHull() {
        if (count_ < 3) return;
        std::sort(points_, points_ + count_, [&](const glm::dvec3& a, const glm::dvec3& b) {
            return a[u_] != b[u_] ? a[u_] < b[u_] : a[v_] < b[v_];
        });
        glm::dvec3 hull[2 * kMost];
        uint32_t kept = 0;
        const auto append = [&](const glm::dvec3& point, uint32_t first) {
            for (; kept >= first + 2; --kept) {
                const glm::dvec3 along = hull[kept - 1] - hull[kept - 2], to = point - hull[kept - 2];
                if (along[u_] * to[v_] - along[v_] * to[u_] > 0) break;
            }
            hull[kept++] = point;
        };
        for (uint32_t i = 0; i < count_; ++i) append(points_[i], 0);
        const uint32_t upper = kept - 1;
        for (uint32_t i = count_ - 1; i-- > 0;) append(points_[i], upper);
        count_ = kept - 1;  // the first one is there twice
        std::copy(hull, hull + count_, points_);
    }

private:
    static constexpr uint32_t kMost = 96;

    int u_, v_;
    glm::dvec3 points_[kMost];
    uint32_t count_ = 0;
};

/// Cuts away where dot(plane, (p, 1)) < least.
/// @param out  receives what is left: no points if nothing is
/// @returns false if there was no room: out is then not usable
inline bool cutBody(std::span<const glm::dvec3> body, const glm::dvec4& plane, double least, PointBody& out) {
    constexpr size_t kFew = 16;
    double heights[PointBody::kMost];
    out.count = 0;
    if (body.size() > PointBody::kMost) return false;
    for (size_t i = 0; i < body.size(); ++i) {
        heights[i] = glm::dot(glm::dvec3(plane), body[i]) + plane.w - least;
        if (heights[i] >= 0) out.points[out.count++] = body[i];
    }
    if (out.count == 0 || out.count == body.size()) return true;
    PlanePoints cut{glm::dvec3(plane)};
    for (size_t i = 0; i < body.size(); ++i)
        for (size_t k = 0; heights[i] > 0 && k < body.size(); ++k)
            if (heights[k] < 0 && !cut.add(body[i] + heights[i] / (heights[i] - heights[k]) * (body[k] - body[i])))
                return false;
    if (out.count + cut.all().size() > kFew) cut.keepHull();
    if (out.count + cut.all().size() > PointBody::kMost) return false;
    SIGHTLINE_DEBUG_ASSERT(out.points != body.data());
    std::copy(cut.all().begin(), cut.all().end(), out.points + out.count);
    out.count += static_cast<uint32_t>(cut.all().size());
    return true;
}

}  // namespace sightline
