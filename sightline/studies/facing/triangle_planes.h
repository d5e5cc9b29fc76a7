// Makes the planes of a mesh's triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/triangle_planes.h"

namespace sightline::studies {

/// The planes of all triangles, in their order. O(triangles).
TrianglePlanes makeTrianglePlanes(const MeshView& mesh, Memory* memory = defaultMemory());

}  // namespace sightline::studies
