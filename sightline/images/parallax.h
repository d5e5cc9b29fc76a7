// How far off an image of a doorway is for another eye: bounds that no point beyond it exceeds.
// SPDX-License-Identifier: MIT
//
// Daniel Aliaga, Anselmo Lastra. Architectural Walkthroughs Using Portal Textures. 1997.
#pragma once

#include <limits>

#include <glm/glm.hpp>

#include "sightline/images/portal_frame.h"

namespace sightline::images {

/// How far beyond a doorway's plane lies what is seen through it.
struct BeyondRange {
    double nearest = 0;                                         ///< [world units, >= 0]
    double farthest = std::numeric_limits<double>::infinity();  ///< [world units, >= nearest]; infinite: the sky
};

/// The usual formula: pixels by which a point at a depth is displaced beside the doorway, for an eye that has moved
/// sideways by an offset.
/// @param focal     resolution / (2 tan(angle of view / 2))  [pixels]
/// @param offset    of the eye from the sample point         [world units]
/// @param z_portal  from the eye to the doorway's plane      [world units]
/// @param z_far     from the eye to the point                [world units]
double parallaxPixels(double focal, double offset, double z_portal, double z_far);

/// The pixels of a view's image that one radian takes up in its middle: `focal` of the others.
double focalLength(const View& view);

/// What an image that was taken for one eye does wrong for another.
struct Displacement {
    double on_plane = 0;  ///< a point beyond appears in the doorway so far from where it should  [world units]
    double pixels = 0;    ///< the same in the image of the new eye, of a view that faces the doorway
    double exposed = 0;   ///< what was hidden and no longer is, is no wider than this in that image  [pixels]
};

/// Bounds for every point in the range that the old eye sees through the frame's rectangle: all that its image shows. With
/// p the point of the plane where the old eye saw it, at depth h beyond, eyes at l and l' beside and z and z' before the plane, it is displaced by
///
///     h / (z' + h) * | (l' - p) + (p - l) z' / z |
///
/// The second factor is affine in p, so largest at a corner, and the first rises with h. For an eye that moves sideways
/// alone this is parallaxPixels(). A view turned away stretches what lies at an angle to its axis by up to 1 / cos^2 of
/// it. Infinite where an eye is not EyePlace::kBefore.
/// @param from   that the image was taken for
/// @param to     that it is shown to
Displacement displacementBound(const PortalFrame& frame, const glm::dvec3& from, const glm::dvec3& to,
                               const BeyondRange& beyond, double focal);

}  // namespace sightline::images
