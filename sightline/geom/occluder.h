// The triangles that may hide something, in the form that the rasterizer reads; made once per mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// A run of triangles that lie close together; drawn, skipped and counted as one.
struct OccluderCluster {
    Box3f bounds;  ///< of its vertices, relative to Occluder::origin
    uint32_t first_vertex = 0, vertex_count = 0;      ///< [limit: <= 256 vertices]
    uint32_t first_triangle = 0, triangle_count = 0;  ///< [limit: <= 128 triangles]
};

/// Occluding triangles of one mesh in clusters. Plain data; prepare/occluder.h makes it.
///
/// Soundness: every triangle here must be certainly drawn wherever the object is drawn
/// (opaque, not masked, blended, transmissive, skinned or morphed).
struct Occluder {
    static constexpr uint8_t kDoubleSided = 1;

    glm::dvec3 origin{0.0};            ///< object space; vertex i lies exactly at origin + vertices[i]
    std::vector<glm::vec3> vertices;   ///< cluster by cluster; a vertex is repeated per cluster
    std::vector<uint32_t> identity;    ///< per vertex: equal iff the positions are equal
    std::vector<uint8_t> triangles;    ///< 3 per triangle, counted from the cluster's first vertex
    std::vector<uint8_t> flags;        ///< per triangle: kDoubleSided or 0
    std::vector<OccluderCluster> clusters;
    Box3f bounds;                      ///< of all vertices, relative to origin

    uint32_t triangleCount() const { return static_cast<uint32_t>(flags.size()); }
};

}  // namespace sightline
