// Why an object is hidden, from the side: the eye, the parts of others that hide it, and their shadows.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/view.h"
#include "sightline/tools/report/pictures/explain_picture.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// Where the shadow of a corner ends: on the ray from the eye, so far from it, or in the corner.
/// @param far  [world units]
glm::dvec3 shadowEnd(const glm::dvec3& eye, const glm::dvec3& corner, double far);

/// The object, its occluders and nothing else, from the side and above, with the frustum. Each outline is drawn with the
/// rays from the eye through its corners, and behind it its shadow, which ends a little behind the object.
/// @param view      a perspective one; its width and height are the picture's
/// @param emphasis  of an object with a finite box
Image<Rgb> shadowPicture(const PictureMaker& maker, const View& view, const Emphasis& emphasis);

}  // namespace sightline::tools
