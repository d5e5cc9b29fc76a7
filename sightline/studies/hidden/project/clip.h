// Clips convex polygons in homogeneous clip space, for hidden-surface methods and the reference alone.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#pragma once

#include <span>

#include <glm/glm.hpp>

namespace sightline::studies {

/// A convex polygon in clip space. A triangle gains at most one vertex per plane.
struct ClipPolygon {
    static constexpr int kMaxPlanes = 7;
    static constexpr int kMaxVertices = 3 + kMaxPlanes;

    glm::dvec4 vertices[kMaxVertices];
    int count = 0;  ///< [limit: <= kMaxVertices]; fewer than 3: nothing is left
};

/// Keeps what satisfies dot(plane, v) >= 0; a vertex on the plane is kept as it is, as all inside ones are, bit by bit.
///
/// A crossing is always computed from the inside end of the edge to the outside one, so that two polygons
/// which share an edge, running in opposite directions, get the same crossing bit by bit. An edge that leaves the
/// inside in a vertex on the plane crosses there and gets no second vertex. What meets the inside in a point or in
/// a line only is nothing; a polygon that lies in the plane is kept.
///
/// @param in   convex; a polygon that is a line or a point is cut like any other  [size: 3 or more vertices, otherwise
///             nothing is left] [limit: |coordinates| <= 1e150; a vertex that is not finite leaves nothing of a polygon]
/// @param out  apart from in  [size: >= in.size() + 1]. One plane adds at most one vertex; where rounding bends a
///             polygon that nearly lies in the plane, so that it would cross more than twice, what does not fit is
///             left out and changes nothing
/// @returns the number of vertices that are left: 0, or 3 and more
int clipToPlane(std::span<const glm::dvec4> in, const glm::dvec4& plane, std::span<glm::dvec4> out);

/// The same for polygons that began as triangles.
/// @param out  another object than in
void clipToPlane(const ClipPolygon& in, const glm::dvec4& plane, ClipPolygon& out);

}  // namespace sightline::studies
