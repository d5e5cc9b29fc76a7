// What occluders are made from, and how they are cut into clusters.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// How occluders are cut into clusters.
struct OccluderSettings {
    uint32_t own_polygons = OccluderCluster::kMaxOwn;  ///< of a joined cluster  [limit: 3 to kMaxOwn]
    /// The same if its polygons do not face one way: where they lie one behind the other, the farthest of them gives
    /// the depth. Smaller clusters hide more there.  [limit: 3 to own_polygons]
    uint32_t folded_polygons = 48;
    bool rings = false;     ///< give joined clusters their neighbours' polygons around them, so that no seam stays open
    bool merge = false;     ///< make larger polygons of those that lie exactly in one plane
    bool junctions = true;  ///< polygons hang together also where a vertex lies, exactly, on another's side
};

/// A mesh of which some triangles hide.
struct OccluderSource {
    MeshView mesh;                          ///< object space
    std::span<const uint8_t> hides;         ///< per triangle: whether it may hide  [size: triangles, or empty for all]
    std::span<const uint8_t> double_sided;  ///< per triangle                       [size: triangles, or empty for none]
};

}  // namespace sightline
