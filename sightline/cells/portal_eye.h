// A view as portals need it: three rows that take a point to the image, and how far anything may be off there.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/cells/portal_window.h"
#include "sightline/geom/view.h"

namespace sightline {

/// A point p of the world is at x = dot(row x, p - origin) + shift.x, and so on, homogeneous: the image is x / w and
/// y / w. One text serves both kinds of views: a parallel one has w = 1 everywhere.
///
/// The rows are taken as they are: a sight line of the view is a line through the origin, or along `direction`.
struct PortalEye {
    glm::dvec3 origin{0.0};  ///< eyePosition() of the view
    glm::dvec3 center{0.0};  ///< where sight lines meet, if they do
    glm::dvec3 rows[3];      ///< x, y, w
    glm::dvec3 shift{0.0};
    double lengths[3];          ///< of the rows
    glm::dvec3 direction{0.0};  ///< of parallel sight lines, unit; else zero
    glm::dvec3 near_corners[4];
    double near_w = 0;    ///< the least w on the near rectangle
    double position = 0;  ///< how far a point may be off, without a portal's own thickness  [world units]
    double wide[2];       ///< |x / w| and |y / w| on a sight line, at most
    double slack[2];      ///< of image coordinates, for rounding
    WindowBounds image;   ///< the whole view

    bool parallel() const { return direction != glm::dvec3(0.0); }
    glm::dvec3 toImage(const glm::dvec3& point) const {
        const glm::dvec3 p = point - origin;
        return {glm::dot(rows[0], p) + shift.x, glm::dot(rows[1], p) + shift.y, glm::dot(rows[2], p) + shift.z};
    }
    /// Whether sight lines may pass a plane from its front to its back.
    bool passes(const glm::dvec4& plane, double thickness) const {
        if (parallel()) return glm::dot(glm::dvec3(plane), direction) <= 0x1p-40;
        return glm::dot(glm::dvec3(plane), center) + plane.w >= -(thickness + position);
    }
    /// Whether what is in front of a plane comes first on sight lines.
    bool frontFirst(const glm::dvec4& plane) const {
        if (parallel()) return glm::dot(glm::dvec3(plane), direction) <= 0;
        return glm::dot(glm::dvec3(plane), center) + plane.w >= 0;
    }
};

/// @param view       isUsable(view)
/// @param tolerance  how far points of the world may be off  [world units]
/// @param reach      their largest coordinate
/// @returns false for views without a near rectangle before the eye, or that are singular apart from depth
bool makePortalEye(const View& view, double tolerance, double reach, PortalEye& eye);

}  // namespace sightline
