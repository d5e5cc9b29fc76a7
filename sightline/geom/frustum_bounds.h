// The box around what a frustum and a region have in common.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/frustum.h"
#include "sightline/math/box.h"

namespace sightline {

/// A box in world space that holds every point of `within` that is inside of all planes. It is the smallest but for
/// rounding if the frustum is bounded by its own planes; where it has no far plane it may be larger. Empty if there is
/// surely no such point.
///
/// Each side follows from planes by weights that are not negative, and so holds whatever rounding made of the weights.
/// @param within  finite
Box3d frustumBounds(const Frustum& frustum, const Box3d& within);

}  // namespace sightline
