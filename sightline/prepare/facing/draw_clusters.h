// Makes what a renderer draws a mesh by, from the mesh and its parts.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "sightline/geom/draw_clusters.h"
#include "sightline/geom/mesh_view.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/merge_facing.h"

namespace sightline {

/// Triangles that are drawn together: of one material.
struct MeshPart {
    uint32_t first = 0, count = 0;  ///< triangles: places in the index buffer / 3
    bool double_sided = false;      ///< is drawn from both sides, and so has no back faces but those inside of solids
    bool hides = true;              ///< is opaque
};

struct DrawClusterSettings {
    FacingCost cost;          ///< what a test costs beside a triangle
    MergeLimits merge;        ///< of single-sided parts
    FacingSettings records;   ///< of single-sided parts
    uint32_t triangles = 64;  ///< of a cluster of a double-sided part  [limit: >= 1]
};

/// Clusters of all triangles of all parts. Those of single-sided parts, and of double-sided ones that bound solids of what
/// hides (findSolids, either way round), are merged by how likely they are seen from their backs together (mergeFacing);
/// those of the other double-sided ones are near one another. O(n log n); deterministic.
/// @param parts  do not overlap; DrawClusters::part is the place here
DrawClusters prepareDrawClusters(const MeshView& mesh, std::span<const MeshPart> parts,
                                 const DrawClusterSettings& settings = {}, Memory* memory = defaultMemory());

}  // namespace sightline
