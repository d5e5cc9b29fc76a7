// Normals for smooth shading, derived from positions alone: faces that meet at less than a crease share theirs.
// SPDX-License-Identifier: MIT
//
// Henri Gouraud. Continuous Shading of Curved Surfaces. 1971.
// Grit Thürmer, Charles Wüthrich. Computing Vertex Normals from Polygonal Facets. 1998.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"

namespace sightline::studies {

/// One normal a corner, object space, on the front's side: the mean of the faces around its position, each by the angle
/// of its corner there, that turn from its own face by no more than the crease. Positions are welded where they are equal
/// bit by bit, whatever their indices. Faces without area take part in nothing, and have normals of length 0; all
/// others' are of unit length.
///
/// @param crease_degrees  0 gives the faces' own normals  [0 to 180]
/// @return [size: 3 * triangles]
std::vector<glm::vec3> smoothNormals(const MeshView& mesh, double crease_degrees = 40);

}  // namespace sightline::studies
