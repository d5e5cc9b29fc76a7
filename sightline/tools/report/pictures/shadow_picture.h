// Why an object is hidden, from the side: the eye, the parts of others that hide it, and their shadows.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/tools/report/pictures/explain_picture.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// How far from the eye the shadow of a part is drawn: behind the object and behind the part.  [world units]
double shadowReach(const glm::dvec3& eye, const Box3d& object, std::span<const glm::dvec3> outline);
/// Where it ends, at the same distance from the eye everywhere: a closed line, with each corner's end and places between.
std::vector<glm::dvec3> shadowEnd(const glm::dvec3& eye, std::span<const glm::dvec3> outline, double reach);

/// The object, its occluders and nothing else, from the side and above, with the frustum. Each outline is drawn with the
/// rays from the eye through its corners, and behind it its shadow, which ends a little behind the object.
/// @param view      a perspective one; its width and height are the picture's
/// @param emphasis  of an object with a finite box
Image<Rgb> shadowPicture(const PictureMaker& maker, const View& view, const Emphasis& emphasis);

}  // namespace sightline::tools
