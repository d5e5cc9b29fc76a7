// An occluder as one rasterizer reads it: plane groups and the edges between them, cluster by cluster, side by side.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/geom/occluder.h"

namespace sightline::bench {

/// Polygons of a cluster that lie in one plane, as nearly as floats tell, are a group: they face an eye together, have one
/// depth, and their inner edges are gone. A group is counted from its cluster's first one.
struct PlaneMesh {
    static constexpr uint32_t kMostGroups = 120, kMostEdges = 448;  ///< of a cluster
    static constexpr uint8_t kNoGroup = 127;                        ///< beside an edge
    static constexpr size_t kPadding = 16;                          ///< arrays of a cluster begin at multiples of it

    struct Cluster {
        uint32_t first_vertex = 0, vertices = 0;
        uint32_t first_group = 0, groups = 0;
        uint32_t first_edge = 0, edges = 0;
        glm::vec3 centre{0.0f}, half{0.0f};  ///< of its box  [object space]
        float radius = 0;                    ///< no vertex is farther from the centre
        float thick = 0;                     ///< the largest of its groups
    };

    std::vector<Cluster> clusters;
    bool is_whole = true;                              ///< every polygon is in a group
    float reach = 0;                                   ///< no coordinate of a box is larger
    std::vector<float> box[6];                         ///< of clusters: centre and half, padded with boxes of no size
    std::vector<float> x, y, z;                        ///< vertices, relative to the cluster's centre
    std::vector<float> nx, ny, nz, nd;                 ///< planes: n.v = nd; n of length 1, towards the front
    std::vector<float> thick;                          ///< no vertex of the group is farther from its plane
    std::vector<float> tilt;                           ///< no normal of its triangles differs by more
    std::vector<float> both;                           ///< 1: it is drawn from both sides; else 0
    std::vector<uint8_t> corners;                      ///< vertices of groups
    std::vector<uint32_t> first_corner, corner_count;  ///< per group
    std::vector<uint8_t> from, to;                     ///< edges: vertices
    std::vector<uint8_t> left, right;                  ///< the groups beside it, as seen from the front; never the same
};

/// Rings are left out. Loose polygons are clusters of their own.
PlaneMesh makePlaneMesh(const Occluder& occluder);

}  // namespace sightline::bench
