// Bounds of what a light reaches, so that lights are culled as objects are: by views, trees, occlusion and boxes.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/cull/bounds.h"
#include "sightline/geom/light.h"
#include "sightline/math/box.h"

namespace sightline {

/// The smallest box along the axes of the world that holds every point that the light may light, made larger by
/// rounding alone. A point light's is around a ball. A spot's is around a ball's sector: the cone of the spot, out to
/// its range, with a round end; any half angle up to pi will do here. Of a sun it is infinite on all sides.
///
/// Given to a world as an object without an occluder, it asks whether the light can matter: an object that a conservative
/// stage culls has no visible point in its box, so the light lights nothing that is seen. A box that is not finite is
/// never culled.
/// @returns  a box that is not finite, if the light is a sun or one of its numbers is of no use
Box3d lightBox(const Light& light);

/// The smallest sphere that holds the same, made larger by rounding alone. A sun's radius is infinite.
Sphere lightSphere(const Light& light);

}  // namespace sightline
