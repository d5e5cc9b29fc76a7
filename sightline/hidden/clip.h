// Clips convex polygons in homogeneous clip space, for the reference renderer alone.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#pragma once

#include <glm/glm.hpp>

namespace sightline {

/// A convex polygon in clip space. A triangle gains at most one vertex per plane.
struct ClipPolygon {
    static constexpr int kMaxPlanes = 7;
    static constexpr int kMaxVertices = 3 + kMaxPlanes;

    glm::dvec4 vertices[kMaxVertices];
    int count = 0;  ///< [limit: <= kMaxVertices]; fewer than 3: nothing is left
};

/// Keeps what satisfies dot(plane, v) >= 0; a vertex on the plane is kept.
///
/// A crossing is always computed from the inside end of the edge to the outside one, so that two polygons
/// which share an edge, running in opposite directions, get the same crossing bit by bit.
///
/// @param out  another object than in
void clipToPlane(const ClipPolygon& in, const glm::dvec4& plane, ClipPolygon& out);

}  // namespace sightline
