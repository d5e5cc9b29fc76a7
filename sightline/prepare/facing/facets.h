// Triangles as what decides their facing: a unit normal and a point of the plane.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"
#include "sightline/prepare/facing/unit_normal.h"

namespace sightline {

/// A triangle that has an area.
struct Facet {
    glm::dvec3 normal;     ///< of unit length; 0: rounding hides how it faces
    glm::dvec3 corner[3];  ///< relative to an origin of the caller's
};

/// True if two corners are the same: never drawn, and faces nobody.
inline bool isDegenerate(const MeshView& mesh, size_t triangle) {
    const glm::vec3 a = mesh.positions[mesh.indices[3 * triangle]], b = mesh.positions[mesh.indices[3 * triangle + 1]],
                    c = mesh.positions[mesh.indices[3 * triangle + 2]];
    return a == b || b == c || c == a;
}

inline Facet facetOf(const MeshView& mesh, size_t triangle, const glm::dvec3& origin) {
    const glm::vec3 a = mesh.positions[mesh.indices[3 * triangle]], b = mesh.positions[mesh.indices[3 * triangle + 1]],
                    c = mesh.positions[mesh.indices[3 * triangle + 2]];
    return {unitNormal(a, b, c), {glm::dvec3(a) - origin, glm::dvec3(b) - origin, glm::dvec3(c) - origin}};
}

}  // namespace sightline
