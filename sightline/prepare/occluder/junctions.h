// Finds T-junctions: vertices that lie exactly on the sides of other polygons.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Sets the patchwork's chains: the vertices that lie, exactly, between the ends of a side. Looks at sides that have no
/// partner or meet it at a sharp angle (boxes that touch), and at vertices of such sides. O(n log n) for what is built;
/// the work is capped, and what is left out only leaves sides open. Deterministic.
void findJunctions(Patchwork& patchwork);

}  // namespace sightline
