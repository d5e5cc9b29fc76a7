// Joins an occluder's polygons to large flat, convex faces.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/base/memory.h"
#include "sightline/cull/volume_shapes.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// Fills `corners`, `outline` and `faces`, by falling area; at most 256 faces. A part of findVolumeParts().
void findVolumeFaces(const Occluder& occluder, Memory* memory, VolumeParts& out);

}  // namespace sightline
