// The region from which a cluster is seen from its back, as a solid that can be drawn.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/geom/facing_clusters.h"
#include "sightline/math/box.h"

namespace sightline {

/// A convex solid by its faces, each planar and counter-clockwise from outside.
struct Polyhedron {
    std::vector<glm::dvec3> positions;
    std::vector<std::vector<uint32_t>> faces;
};

/// The part of a box in which a volume culls: the region is what eight half spaces have in common, one for each corner of the
/// box of normals, and often without end. Without faces if there is none.
/// @param box  relative to FacingClusters::origin, as the volume
Polyhedron volumePolyhedron(const CullingVolume& volume, const Box3d& box);

/// The faces cut into triangles, for a file or a renderer.
/// @returns three positions' numbers each
std::vector<uint32_t> trianglesOf(const Polyhedron& polyhedron);

}  // namespace sightline
