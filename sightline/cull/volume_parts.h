// The parts of an occluder that can hide things by themselves: large convex faces, and convex bodies of several faces.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
#pragma once

#include "sightline/base/memory.h"
#include "sightline/cull/volume_shapes.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// Finds the largest parts. Polygons are joined where they share a side bit for bit, lie in one plane within 1e-4 of
/// their size, and make a convex outline; faces are joined to a body while each lies behind all others. What is joined
/// badly hides less, never more than it should: the volumes rest on the outline alone. O(n log n) in the polygons, of
/// which the 65,536 largest count. Deterministic.
VolumeParts findVolumeParts(const Occluder& occluder, Memory* memory = defaultMemory());

}  // namespace sightline
