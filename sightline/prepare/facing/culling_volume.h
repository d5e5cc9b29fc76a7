// Makes the volumes from which clusters are seen from their backs, and measures how much of space they are.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "sightline/geom/facing_clusters.h"
#include "sightline/math/box.h"
#include "sightline/prepare/facing/facets.h"

namespace sightline {

inline double taxicabLength(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// The volume around a given origin. O(facets). One without a normal makes it one that never culls.
CullingVolume cullingVolumeAt(std::span<const Facet> facets, const glm::vec3& origin);

/// The volume around the origin, among the centre and the corners of the facets' box, from which the largest share of the eyes'
/// space culls.
/// @param eyes  where eyes may be, relative to the facets' own origin
CullingVolume makeCullingVolume(std::span<const Facet> facets, const Box3d& eyes);

/// The normals' box in a frame whose third axis is their mean.
TurnedBox makeTurnedBox(std::span<const Facet> facets);

/// The volume of two clusters together, around an origin of its own: culls a subset of what both cull. Conservative
/// where the origins differ; volumes made from the facets themselves are larger. O(1).
CullingVolume joinVolumes(const CullingVolume& a, const CullingVolume& b, const glm::vec3& origin);

/// The share of a box of eyes from which a volume culls, P(C): exact but for rounding of about 1e-6. In each octant around the
/// origin the volume is a half space, and what that leaves of a box is a sum of eight cubes.
double cullingProbability(const CullingVolume& volume, const Box3d& eyes);

/// The part of a box in the half space weight * x <= limit, x counted from the box's lowest corner; 0 to its volume.
double volumeBelow(const glm::dvec3& sides, const glm::dvec3& weight, double limit);

}  // namespace sightline
