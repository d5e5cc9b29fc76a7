// Shapes asked of the depth tiles: rectangles, boxes by their faces, spheres, convex hulls.
// SPDX-License-Identifier: MIT
//
// David Eberly. Perspective Projection of an Ellipsoid. 1999 (the bounds of a sphere's image).
#pragma once

#include <span>

#include "sightline/buffer/ask/occludee.h"
#include "sightline/cull/occludee_place.h"

namespace sightline {

/// All of these answer kVisible when in doubt: for shapes that touch the near plane, hold the eye, or are not finite.
/// They answer kOutside only for shapes that surely miss the viewport widened by the jitter. `screen` is makeScreen()
/// of the view that the tiles were drawn for.

/// A rectangle of the viewport.
struct ViewportRect {
    double left = 0, top = 0, right = 0, bottom = 0;  ///< [viewport pixels from the left and the top]
    double depth = 0;  ///< no point of what is asked about is nearer, along the direction of view  [world units]
};
Sight askRect(DepthTiles& tiles, const Screen& screen, const View& view, const ViewportRect& rect);

/// A box under a transform: first the smallest rectangle around its image, then the faces that are turned to the eye,
/// with a depth per pixel.
/// @param place  makeOccludeePlace() of the transform and the box
Sight askBox(DepthTiles& tiles, const OccludeePlace& place, const Box3d& box);

/// The box's faces that are turned to the eye.
struct BoxFaces {
    PixelRect rect;  ///< around its image
    OccludeePolygon faces[6];
    int count = 0;
};
/// @returns kVisible in doubt, kOutside, or kOccluded: `out` is made
Sight makeBoxFaces(const OccludeePlace& place, const Box3d& box, BoxFaces& out);

/// A sphere: the smallest octagon around its image, with its nearest depth.
/// @param center  world space
/// @param radius  [world units, >= 0]
Sight askSphere(DepthTiles& tiles, const Screen& screen, const glm::dvec3& center, double radius);

/// The convex hull of points: the hull of their images, with the nearest depth of all.
Sight askPoints(DepthTiles& tiles, const OccludeePlace& place, std::span<const glm::vec3> points);

/// A convex solid by its faces, with a depth per pixel.
struct HullView {
    std::span<const glm::vec3> points;
    std::span<const uint32_t> corners;     ///< the faces' points, counter-clockwise from outside, face by face
    std::span<const uint32_t> face_sizes;  ///< corners of each face  [each >= 3]
};
Sight askHull(DepthTiles& tiles, const OccludeePlace& place, const HullView& hull);

}  // namespace sightline
