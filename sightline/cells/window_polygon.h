// Convex polygons of the image, cut by half-planes and joined.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
// Alex Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. 1979.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/cells/portal_window.h"

namespace sightline {

/// Where dot(line, (x, y, 1)) >= 0.
using WindowLine = glm::dvec3;

/// Counter-clockwise. Cutting and joining move an edge by rounding, 2^-50 of the coordinates or less.
struct WindowPolygon {
    static constexpr uint32_t kMost = 16;

    glm::dvec2 points[kMost];
    uint32_t count = 0;
    WindowBounds bounds;

    WindowPolygon() {}
    WindowPolygon(const WindowPolygon& other) { *this = other; }
    /// Copies the points that there are.
    WindowPolygon& operator=(const WindowPolygon& other) {
        count = other.count;
        bounds = other.bounds;
        for (uint32_t i = 0; i < count; ++i) points[i] = other.points[i];
        return *this;
    }

    void findBounds();
    double area() const;
    /// By more than `slack` nowhere outside of another.
    bool isWithin(const WindowPolygon& other, double slack) const;
};

/// Whether two polygons have an edge in common, from end to end, to within `slack`.
bool shareEdge(const WindowPolygon& a, const WindowPolygon& b, double slack);

/// The polygon between eight bounds.
WindowPolygon polygonOf(const WindowBounds& bounds);

/// Keeps the inner side of a line; without points if nothing is left. Where there is no room for another corner the
/// polygon stays as it is.
void cutPolygon(WindowPolygon& polygon, const WindowLine& line);

/// The hull of two; if that has too many corners, the eight bounds of both.
WindowPolygon hullOf(const WindowPolygon& a, const WindowPolygon& b);

}  // namespace sightline
