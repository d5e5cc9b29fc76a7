// The triangles that may hide something, in the form that the rasterizer reads; made once per mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/geom/plane_mesh.h"
#include "sightline/math/box.h"

namespace sightline {

/// A triangle, or two triangles 0 1 2 and 0 2 3 that make a convex and nearly flat quadrangle. Counter-clockwise
/// is front.
struct OccluderPolygon {
    static constexpr uint8_t kNone = 255;
    uint8_t vertex[4] = {0, 0, 0, kNone};  ///< counted from the cluster's first; the last is kNone in a triangle
    bool double_sided = false;

    int corners() const { return vertex[3] == kNone ? 3 : 4; }
};

/// A side of a polygon or a part of it, or one that two polygons of a cluster share. Where more than two polygons meet,
/// or two that run the same way, there are several records, and each side of each polygon is in one of them.
struct OccluderEdge {
    static constexpr uint8_t kNone = 255;
    uint8_t from = 0, to = 0;  ///< counted from the cluster's first vertex
    uint8_t left = kNone;      ///< the polygon of the cluster that runs from -> to, counter-clockwise
    uint8_t right = kNone;     ///< the one that runs to -> from; or kNone
};

/// A run of polygons that lie close together; drawn, skipped and counted as one. Either it is joined (its own polygons
/// hang together in the mesh) and has its edges, or it is loose and has none.
struct OccluderCluster {
    static constexpr uint32_t kMaxVertices = 240;
    static constexpr uint32_t kMaxOwn = 128;       ///< polygons of its own
    static constexpr uint32_t kMaxPolygons = 250;  ///< with those of its ring
    static constexpr uint32_t kMaxLoose = 60;      ///< polygons of a loose cluster

    Box3f bounds;                                   ///< of its own polygons' vertices
    uint32_t first_vertex = 0, vertex_count = 0;    ///< [limit: <= kMaxVertices]; first is a multiple of 8
    uint32_t first_polygon = 0, polygon_count = 0;  ///< its own polygons [limit: <= kMaxOwn; <= kMaxLoose if loose]
    /// Polygons after its own that belong to neighbours, and close the seam to them.
    uint32_t ring_count = 0;                  ///< [limit: polygon_count + ring_count <= kMaxPolygons]
    uint32_t first_edge = 0, edge_count = 0;  ///< of all its polygons; none in a loose cluster
    uint32_t triangle_count = 0;              ///< of its own polygons
};

/// Occluding triangles of one mesh in clusters, in object space. Plain data; prepare/occluder/occluder.h makes it.
///
/// Every triangle here must be certainly drawn wherever the object is drawn (opaque; not masked, blended,
/// transmissive, skinned or morphed). Positions are the mesh's own, bit for bit: two triangles share an
/// edge exactly when the end points are equal.
struct Occluder {
    Array<float> x, y, z;  ///< vertices, cluster by cluster, each cluster padded to 8 with its last one
    Array<OccluderPolygon> polygons;
    Array<OccluderEdge> edges;
    Array<OccluderCluster> clusters;
    Box3f bounds;      ///< of all vertices, those of rings too
    PlaneMesh planes;  ///< the same triangles as they are drawn: geom/make_plane_mesh.h

    explicit Occluder(Memory* memory = defaultMemory())
        : x(memory), y(memory), z(memory), polygons(memory), edges(memory), clusters(memory), planes(memory) {}

    uint32_t triangleCount() const {
        uint32_t count = 0;
        for (const OccluderCluster& cluster : clusters) count += cluster.triangle_count;
        return count;
    }
};

/// A simpler occluder in the place of another one; prepare/inner/inner.h makes it. What it hides from an eye outside of
/// `outside`, the other one hides from there, too.
struct InnerOccluder {
    Occluder occluder;
    Box3f outside;    ///< holds all that is drawn of the solids that it stands for
    float error = 0;  ///< how much less it hides: how far inside it lies, about  [units of the positions]

    explicit InnerOccluder(Memory* memory = defaultMemory()) : occluder(memory) {}
};

}  // namespace sightline
