// Puts triangles into clusters that are likely to be seen from their backs together.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/facing_clusters.h"
#include "sightline/geom/mesh_view.h"

namespace sightline {

/// What a frame costs: each cluster a test, each triangle of one that is not culled a triangle.
struct FacingCost {
    double test = 4.0;       ///< t / r: a cluster's test, in triangles  [> 0]
    double eye_space = 3.0;  ///< eyes are anywhere in the mesh's box, made larger by this factor around its centre
};

/// Clusters as runs of a new order of the triangles.
struct FacingPartition {
    std::vector<uint32_t> triangles;  ///< by their place in mesh.indices / 3; a permutation
    std::vector<uint32_t> sizes;      ///< of the clusters
    double cost = 0;                  ///< of a frame on average, in triangles, as modelledCost()
};

struct MergeLimits {
    uint32_t triangles = 64;  ///< of a cluster  [limit: >= 1]
    int rounds = 4;           ///< of neighbours that touch nowhere but lie near and face alike, after those that touch
};

/// Merges clusters, at first of a triangle each, as long as two of them cost less as one: T(C) < T(A) + T(B) with
/// T(C) = t + (1 - P(C)) n r. The pair that saves most is next; touching pairs first. What saves nothing by
/// itself fills up clusters with its like; triangles that face nobody for sure are put aside, into clusters that are never culled. Clusters that face alike lie next to one another in the end.
/// O(n log n) if clusters are small.
FacingPartition mergeFacing(const MeshView& mesh, const FacingCost& cost = {}, const MergeLimits& limits = {});

/// The sum of T over clusters, for eyes anywhere in the space of the costs: T = t + (1 - P) n, in triangles. What volumes
/// alone cull.
double modelledCost(const FacingClusters& clusters, const MeshView& mesh, const FacingCost& cost);

}  // namespace sightline
