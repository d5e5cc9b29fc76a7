// Makes an occluder from a mesh: its hiding triangles, bit for bit, in pairs and clusters.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// How occluders are cut into clusters.
struct OccluderSettings {
    uint32_t own_polygons = OccluderCluster::kMaxOwn;  ///< of a joined cluster  [limit: 3 to kMaxOwn]
};

/// Prepares the given triangles as an occluder.
///
/// Keeps every triangle except those that name a vertex twice or whose positions are not finite.
/// Positions are kept bit for bit (a negative zero becomes zero); nothing is welded by tolerance.
/// Triangles that share an edge and make a convex, nearly flat quadrangle are paired. Three polygons or more that hang
/// together by shared edges make joined clusters of their own; all others are gathered in loose ones. O(n log n).
///
/// @param mesh          object space
/// @param hides         per triangle: whether it may hide  [size: triangles, or empty for all]
/// @param double_sided  per triangle                       [size: triangles, or empty for none]
Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides = {},
                         std::span<const uint8_t> double_sided = {}, const OccluderSettings& settings = {});

}  // namespace sightline
