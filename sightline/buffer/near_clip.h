// Clips occluder polygons at the near plane, remembering which mesh edges its sides lie on.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#pragma once

#include "sightline/buffer/tiles.h"

namespace sightline {

/// Cuts a convex polygon.
/// @param vertices  indices into the cluster's vertices  [size: count, 3 or 4]
/// Returns false if nothing is left in front of the near plane.
bool clipAtNear(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, const uint8_t* vertices,
                int count, ClippedPolygon& out);

}  // namespace sightline
