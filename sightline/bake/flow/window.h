// A window: the part of a portal that light can pass after a chain of portals, as a convex polygon.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include <glm/glm.hpp>

namespace sightline::bake {

/// A convex polygon with room for a few dozen corners; coordinate by coordinate, for vectors of corners.
struct Window {
    static constexpr uint32_t kMost = 40;
    /// Vectors may read beyond the last corner, and the first corner stands there again.
    static constexpr uint32_t kRoom = kMost + 8;

    uint32_t count = 0;
    bool straight = false;  ///< before it was cut, no corner bulged beyond the line of an edge by more than rounding
    double x[kRoom], y[kRoom], z[kRoom];

    glm::dvec3 corner(uint32_t i) const { return {x[i], y[i], z[i]}; }
    void add(const glm::dvec3& point) {
        x[count] = point.x;
        y[count] = point.y;
        z[count++] = point.z;
    }
    /// Call it after the last add().
    void close() {
        x[count] = x[0];
        y[count] = y[0];
        z[count] = z[0];
    }
    /// @return false if it has too many corners
    bool assign(std::span<const glm::dvec3> outline, bool is_straight = false) {
        count = 0;
        straight = is_straight;
        if (outline.size() > kMost) return false;
        for (const glm::dvec3& point : outline) add(point);
        close();
        return true;
    }
    void assign(const Window& other) {
        count = other.count;
        straight = other.straight;
        for (uint32_t i = 0; i <= count; i += 8) {  // in blocks of a known size
            std::memcpy(x + i, other.x + i, 8 * sizeof(double));
            std::memcpy(y + i, other.y + i, 8 * sizeof(double));
            std::memcpy(z + i, other.z + i, 8 * sizeof(double));
        }
    }
    glm::dvec3 center() const {
        glm::dvec3 sum(0);
        for (uint32_t i = 0; i < count; ++i) sum += corner(i);
        return sum / static_cast<double>(count);
    }
};

/// Planes that two windows lie on either side of: no point of the first is above, none of the second below. Along a
/// line from a point of the first through a point of the second the height grows, and beyond the second it is not
/// negative.
struct Separators {
    static constexpr uint32_t kRoom = 2 * Window::kMost + 8;

    uint32_t count = 0;
    bool straight = false;  ///< as it was made: no corner bulges beyond the line of an edge by more than rounding
    double x[kRoom], y[kRoom], z[kRoom], w[kRoom];  ///< unit normal and distance
};

enum class Clipped : uint8_t { kWhole, kCut, kGone };

}  // namespace sightline::bake
