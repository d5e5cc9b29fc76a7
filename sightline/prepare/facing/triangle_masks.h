// Makes the masks that say, per sector of space around a cluster, which of its triangles are seen from their backs.
// SPDX-License-Identifier: MIT
//
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015.
#pragma once

#include <span>
#include <vector>

#include "sightline/geom/facing_clusters.h"
#include "sightline/prepare/facing/facets.h"

namespace sightline {

/// Appends the masks of one cluster: the box around its facets, and for each sector a bit for each facet that is seen from its
/// back from everywhere in the sector outside of the box. Eye = center + r * shape * d with r >= half and d on the unit cube: what
/// holds for the four corners of a cell and both r = half and r without end, holds between. O(facets * sectors).
/// @param shape  of the box: its sides over the longest  [limit: 1/32 to 1]
/// @param steps  cells on each side of a face of the cube  [limit: 1 to TriangleMasks::kMaxSteps]
TriangleMasks addTriangleMasks(std::span<const Facet> facets, const glm::dvec3& shape, uint32_t steps,
                               Array<uint64_t>& words);

}  // namespace sightline
