// The triangles that may hide something, in the form that the rasterizer reads; made once per mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/math/box.h"

namespace sightline {

/// A run of triangles that lie close together; drawn, skipped and counted as one.
struct OccluderCluster {
    static constexpr uint32_t kMaxVertices = 256;
    static constexpr uint32_t kMaxTriangles = 128;

    Box3f bounds;                                     ///< of its vertices
    uint32_t first_vertex = 0, vertex_count = 0;      ///< [limit: <= kMaxVertices]; first is a multiple of 8
    uint32_t first_triangle = 0, triangle_count = 0;  ///< [limit: <= kMaxTriangles]
};

/// Occluding triangles of one mesh in clusters, in object space. Plain data; prepare/occluder.h makes it.
///
/// Every triangle here must be certainly drawn wherever the object is drawn (opaque; not masked, blended,
/// transmissive, skinned or morphed). Positions are the mesh's own, bit for bit: two triangles share an
/// edge exactly when the end points are equal.
struct Occluder {
    static constexpr uint8_t kDoubleSided = 1;

    std::vector<float> x, y, z;      ///< vertices, cluster by cluster, each cluster padded to 8 with its last one
    std::vector<uint8_t> triangles;  ///< 3 per triangle, counted from the cluster's first vertex
    std::vector<uint8_t> flags;      ///< per triangle: kDoubleSided or 0
    std::vector<OccluderCluster> clusters;
    Box3f bounds;                    ///< of all vertices

    uint32_t triangleCount() const { return static_cast<uint32_t>(flags.size()); }
};

}  // namespace sightline
