// How far boxes lie from a view's eye: the measure behind distance culling, eight children of a tree node at once.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/cull/frustum.h"
#include "sightline/geom/view.h"

namespace sightline {

/// What distance means in a view: in perspective to the eye; in a parallel view, where the eye has no place across the
/// direction of view, to the plane through it.
struct DistanceMeasure {
    bool perspective = true;
    glm::vec3 toward{0.0f};  ///< of a parallel view: unit direction that it looks in
};

/// @param view  isUsable(view)
DistanceMeasure makeDistanceMeasure(const View& view);

/// How many times as far limits of distance reach in this view: farther where it is narrower than View::max_distance_fov,
/// by as much as it enlarges what it shows. 1 in parallel views, and where no such angle is given.
double distanceZoom(const View& view);

/// The squares of the distances to the nearest points of eight boxes; 0 of a box that holds the eye, or reaches behind it
/// in a parallel view. Rounded, by 2^-20 of themselves at most; a box inside another one is never nearer.
/// Of boxes that are no numbers nothing is promised but that no trap is sprung.
/// @param squares  [size: 8] [world units squared]
void squaredDistances(const DistanceMeasure& measure, const EyeBoxes& boxes, float* squares);

}  // namespace sightline
