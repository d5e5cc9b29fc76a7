// An occluder as the rasterizer reads it: plane groups and the edges between them, cluster by cluster, side by side.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/base/array.h"

namespace sightline {

/// Polygons of a cluster that lie in one plane, as nearly as floats tell, are a group: they face an eye together, have one
/// depth, and their inner edges are gone. A group is counted from its part's first one. Plain data; geom/make_plane_mesh.h makes it.
struct PlaneMesh {
    static constexpr uint32_t kMostGroups = 120, kMostEdges = 448;  ///< of a part
    static constexpr uint8_t kNoGroup = 127;                        ///< beside an edge
    static constexpr uint32_t kLeastCost = 8;                       ///< of a part
    static constexpr size_t kPadding = 16;                          ///< arrays of a part begin at multiples of it

    /// What is drawn at once: a cluster of the occluder, or where that has too many groups or edges, some of its polygons.
    struct Part {
        uint32_t first_vertex = 0, vertices = 0;
        uint32_t first_group = 0, groups = 0;
        uint32_t first_edge = 0, edges = 0;
        glm::vec3 centre{0.0f}, half{0.0f};        ///< of its box  [object space]
        float radius = 0;                          ///< no vertex is farther from the centre
        uint32_t cost = 0;                         ///< costOf()
        uint32_t cluster = 0;                      ///< of the occluder, whose polygons these are:
        uint32_t first_polygon = 0, polygons = 0;  ///< the first one among the cluster's
        uint32_t first_group_of = 0;               ///< in group_of
    };

    Array<Part> parts;
    bool is_whole = true;                        ///< every polygon is in a group
    Array<uint32_t> first_part;                  ///< per cluster of the occluder, and behind the last one
    Array<float> x, y, z;                        ///< vertices, relative to the part's centre
    Array<uint8_t> source;                       ///< per vertex: which of the cluster's it is
    Array<uint8_t> group_of;                     ///< per polygon of a part
    Array<float> nx, ny, nz, nd;                 ///< planes: n.v = nd; n of length 1, towards the front
    Array<float> thick;                          ///< no vertex of the group is farther from its plane
    Array<float> tilt;                           ///< no normal of its triangles differs by more
    Array<float> both;                           ///< 1: it is drawn from both sides; else 0
    Array<uint8_t> corners;                      ///< vertices of groups
    Array<uint32_t> first_corner, corner_count;  ///< per group
    Array<uint8_t> from, to;                     ///< edges: vertices
    Array<uint8_t> left, right;                  ///< the groups beside it, as seen from the front; never the same

    explicit PlaneMesh(Memory* memory = defaultMemory())
        : parts(memory),
          first_part(memory),
          x(memory),
          y(memory),
          z(memory),
          source(memory),
          group_of(memory),
          nx(memory),
          ny(memory),
          nz(memory),
          nd(memory),
          thick(memory),
          tilt(memory),
          both(memory),
          corners(memory),
          first_corner(memory),
          corner_count(memory),
          from(memory),
          to(memory),
          left(memory),
          right(memory) {}

    /// What drawing a cluster costs, about, in edges that bound its image: all that bound the cluster, and a few of those between
    /// its groups.
    uint32_t costOf(uint32_t cluster) const {
        uint32_t cost = 0;
        for (uint32_t part = first_part[cluster]; part < first_part[cluster + 1]; ++part) cost += parts[part].cost;
        return cost;
    }
};

}  // namespace sightline
