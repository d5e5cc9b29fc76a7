// Sorts a mesh's triangles into classes by the direction in which they face.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Kenneth Hoff. Fast Backface Culling Using Normal Masks. 1997.
#pragma once

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/normal_classes.h"

namespace sightline {

/// The class of a direction: (face * cells + row) * cells + column, the faces being +x, -x, +y, -y, +z, -z, column along
/// the next axis, row along the one after it. On a border between classes either of them.
/// @param direction  not 0; of any length
/// @param cells      [limit: 1 to NormalClasses::kMaxCells]
int normalClass(const glm::dvec3& direction, int cells);

/// The classes of all triangles, in their order. O(triangles).
NormalClasses makeNormalClasses(const MeshView& mesh, int cells = 16, Memory* memory = defaultMemory());

}  // namespace sightline
