// Gathers the polygons of an occluder's clusters by planes.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/occluder.h"

namespace sightline {

/// Fills Occluder::planes by the rest of it. Triangles whose area is next to nothing are left out: they hide nothing.
void makePlaneMesh(Occluder& occluder);

}  // namespace sightline
