// Which form of an occluder a view draws: the mesh's own polygons, or simpler ones inside of its solids.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/screen.h"
#include "sightline/geom/view_limits.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// The simplest form whose error is at most so large on the screen, if nothing of the solids lies before the near plane
/// or within its guard. All rays that are looked along then begin outside of the solids, and the solids' surfaces are
/// drawn where rays enter them: what the simpler form hides is hidden.
///
/// @param most_error  [pixels of the occlusion buffer; 0: the mesh's own polygons]
const Occluder& formFor(const HeldOccluder& occluder, const Screen& screen, const glm::dmat4& transform,
                        double most_error);

/// True if no section cuts anything that an occluder, or one in its place, stands for.
bool isWhole(const ViewLimits& limits, const HeldOccluder& occluder, const glm::dmat4& transform);

/// True if no section cuts any polygon that a cluster is drawn by, those of its ring too.
bool isWhole(const ViewLimits& limits, const Occluder& occluder, const OccluderCluster& cluster,
             const glm::dmat4& transform);

}  // namespace sightline::detail
