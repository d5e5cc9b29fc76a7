// Merges polygons that lie exactly in one plane into larger triangles and convex quadrangles.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Merges two polygons that share a side, again and again, longest side first, wherever what they make together has
/// three or four corners: a wall that is tessellated into rectangles becomes one rectangle. The points that are covered
/// stay the same, exactly: polygons are merged only if all corners lie in one plane and what is no corner any more lies
/// on a side, by exact predicates; and only if both are double-sided, or neither. Call it before findJunctions(): a
/// corner that vanishes may remain one of other polygons. Deterministic; O(n log n) a round, and at most 64 rounds.
///
/// @param by_mesh  merge only polygons of the same mesh
void mergeCoplanar(Patchwork& patchwork, bool by_mesh);

}  // namespace sightline
