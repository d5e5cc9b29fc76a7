// Clips an occluder triangle at the near plane, remembering which mesh edges its sides lie on.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#pragma once

#include "sightline/raster/tiles.h"

namespace sightline {

/// @param vertices  three indices into the cluster's vertices
/// Returns false if nothing is left in front of the near plane.
bool clipAtNear(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, const uint8_t* vertices,
                ClippedPolygon& out);

}  // namespace sightline
