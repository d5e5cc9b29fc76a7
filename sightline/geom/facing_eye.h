// The eye of a view in an object's own space, and how well it is known there: what every test for back faces starts from.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/geom/front_face.h"
#include "sightline/geom/view.h"

namespace sightline {

/// Seen from here a triangle with normal n and a corner p is a back face iff n * (point - w * p) <= 0.
///
/// The sign is that of the object's own space, in which nothing is mirrored: a mirroring transform turns a triangle's
/// winding about together with its front, and needs no further care.
struct FacingEye {
    glm::dvec3 point{0.0};  ///< the eye; in a parallel view, the unit vector towards it
    double w = 1.0;         ///< 1; in a parallel view, 0
    double error = 0.0;     ///< the true point lies no farther away  [units of the object]; infinite: nothing is known
    FrontFace front = FrontFace::kCounterClockwise;  ///< of the object's triangles

    /// False: no face may be taken for a back face.
    bool known() const { return error < 1e30; }
};

/// The eye of a view in the space of an object.
///
/// `error` bounds all rounding on the way, whatever the transform: it is found from what remains when the solution is put
/// back into the equation. A transform that cannot be inverted, and anything that is not finite, gives an eye that is
/// not known.
///
/// @param view       the view matrix rigid, as View wants it
/// @param transform  object to world, affine
FacingEye facingEye(const View& view, const glm::dmat4& transform, FrontFace front = FrontFace::kCounterClockwise);

/// Vectors along which the edges of the window are seen from the eye, in the object's space: counter-clockwise from the
/// lower left one, widened by the view's jitter. In a parallel view all four are the same. Pointing away from the eye; in perspective to one depth,
/// so that what is seen at a place between the corners is affine in it.
struct CornerRays {
    glm::dvec3 ray[4];
    double error = 0.0;  ///< of each ray, as a share of its length; infinite: nothing is known

    bool known() const { return error < 1e-6; }
};

/// @param window  of the view, in clip x and y over w: left, bottom, right, top
CornerRays cornerRays(const View& view, const glm::dmat4& transform, const glm::dvec4& window = {-1, -1, 1, 1});

}  // namespace sightline
