// Makes the cones from which clusters are seen from their backs.
// SPDX-License-Identifier: MIT
//
// Arseny Kapoulkine. meshoptimizer 0.18. 2022.
// Mihai Badoiu, Kenneth Clarkson. Smaller Core-Sets for Balls. 2003 (the axis).
#pragma once

#include <span>

#include "sightline/geom/facing_clusters.h"
#include "sightline/prepare/facing/facets.h"

namespace sightline {

/// The cone of the facets: its axis is the middle of the smallest ball around their normals, its apex the highest point on a line
/// along it through the middle of their box that lies behind all of them. Never culls where the normals span nearly a
/// half space, or where there is one without a normal. O(facets).
FacingCone makeFacingCone(std::span<const Facet> facets);

}  // namespace sightline
