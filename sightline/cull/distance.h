// How far boxes lie from a view's eye: the measure behind distance culling, eight children of a tree node at once.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/cull/frustum.h"
#include "sightline/geom/view.h"

namespace sightline {

/// What distance means in a view. In perspective it is the distance to the eye. In a parallel view the eye has no place
/// across the direction of view: there it is the distance to the plane through the eye.
struct DistanceMeasure {
    bool perspective = true;
    glm::vec3 toward{0.0f};  ///< of a parallel view: unit direction that it looks in
};

/// @param view  isUsable(view)
DistanceMeasure makeDistanceMeasure(const View& view);

/// By how much limits of distance are multiplied in this view. A view that is narrower than the angle that they are
/// meant for enlarges what it shows, and sees farther by as much. 1 in parallel views, and without such an angle.
/// @param fov  QuerySettings::max_distance_fov  [radians; 0: none]
double distanceZoom(const View& view, double fov);

/// The squares of the distances to the nearest points of eight boxes; 0 for a box that holds the eye, or that reaches
/// behind it in a parallel view. They are rounded by 2^-20 of themselves at most; a box inside another one is never
/// nearer. A box that is not a number gets any answer, without a trap.
/// @param squares  [size: 8] [world units squared]
void squaredDistances(const DistanceMeasure& measure, const EyeBoxes& boxes, float* squares);

}  // namespace sightline
