// What the tests of occluder preparation share: seeded meshes, and the laws of a cluster's records by brute force.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/geom/occluder.h"
#include "sightline/prepare/occluder/exact.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/meshes.h"

namespace sightline {

struct Soup : test::TestMesh {
    /// A box with its faces outward, each with vertices of its own.
    void addBox(const glm::vec3& a, const glm::vec3& b) {
        const std::vector<glm::vec3> at = test::boxMesh(a, b).positions;
        for (const auto& f : test::kBoxFaces) add({at[f[0]], at[f[1]], at[f[2]], at[f[3]]});
    }
};

inline std::vector<OccluderSource> sourcesOf(const std::vector<Soup>& soups) {
    std::vector<OccluderSource> sources;
    for (const Soup& soup : soups) sources.push_back({soup.view(), {}, {}});
    return sources;
}

/// A closed surface of 8 * n * n triangles: an octahedron, each face divided n by n, blown up to a bumpy sphere.
inline Soup makeBall(uint64_t seed, uint32_t n) {
    Soup soup;
    const auto place = [&](int sx, int sy, int sz, uint32_t i, uint32_t j) {
        const int k = int(n - i - j);
        glm::dvec3 p(sx * int(i), sy * int(j), sz * k);
        const uint64_t at = uint64_t(p.x + n) << 40 | uint64_t(p.y + n) << 20 | uint64_t(p.z + n);
        Random random(mixSeed(seed, at));
        return glm::vec3(glm::normalize(p) * (1.0 + 0.05 * random.uniform()));
    };
    for (int octant = 0; octant < 8; ++octant) {
        const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
        const auto addTriangle = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
            soup.add(sx * sy * sz > 0 ? std::vector{a, b, c} : std::vector{a, c, b});
        };
        for (uint32_t i = 0; i < n; ++i)
            for (uint32_t j = 0; i + j < n; ++j) {
                addTriangle(place(sx, sy, sz, i, j), place(sx, sy, sz, i + 1, j), place(sx, sy, sz, i, j + 1));
                if (i + j + 1 < n)
                    addTriangle(place(sx, sy, sz, i + 1, j), place(sx, sy, sz, i + 1, j + 1),
                                place(sx, sy, sz, i, j + 1));
            }
    }
    return soup;
}

inline glm::vec3 positionOf(const Occluder& o, const OccluderCluster& c, uint32_t v) {
    const size_t at = size_t{c.first_vertex} + v;
    return {o.x[at], o.y[at], o.z[at]};
}

/// Open edges of polygons that are a cluster's own.
inline uint32_t ownOpenEdges(const Occluder& o) {
    uint32_t count = 0;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e)
            count += o.edges[e].right == OccluderEdge::kNone && o.edges[e].left < c.polygon_count;
    return count;
}

using Point = std::array<float, 3>;
inline Point pointOf(const Occluder& o, const OccluderCluster& c, uint32_t v) {
    const glm::vec3 p = positionOf(o, c, v);
    return {p.x, p.y, p.z};
}

/// A polygon by its corners, whichever comes first.
using Corners = std::vector<Point>;
inline Corners cornersOf(const Occluder& o, const OccluderCluster& c, uint32_t polygon) {
    Corners corners;
    const OccluderPolygon& p = o.polygons[c.first_polygon + polygon];
    for (int k = 0; k < p.corners(); ++k) corners.push_back(pointOf(o, c, p.vertex[k]));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// Limits, padding, bounds: what holds for every cluster.
inline void expectWithinLimits(const Occluder& o) {
    for (size_t v = 0; v < o.x.size(); ++v)
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE((axis == 0 ? o.x : axis == 1 ? o.y : o.z)[v], o.bounds.min[axis]);
            EXPECT_LE((axis == 0 ? o.x : axis == 1 ? o.y : o.z)[v], o.bounds.max[axis]);
        }
    for (const OccluderCluster& c : o.clusters) {
        EXPECT_LE(c.vertex_count, OccluderCluster::kMaxVertices);
        EXPECT_GT(c.polygon_count, 0u);
        EXPECT_LE(c.polygon_count, c.edge_count ? OccluderCluster::kMaxOwn : OccluderCluster::kMaxLoose);
        EXPECT_LE(c.polygon_count + c.ring_count, OccluderCluster::kMaxPolygons);
        EXPECT_EQ(c.first_vertex % 8, 0u);
        Box3f own;
        uint32_t triangles = 0;
        for (uint32_t p = 0; p < c.polygon_count + c.ring_count; ++p) {
            const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
            for (int k = 0; k < polygon.corners(); ++k) {
                EXPECT_LT(polygon.vertex[k], c.vertex_count);
                if (p < c.polygon_count) own.grow(positionOf(o, c, polygon.vertex[k]));
            }
            if (p < c.polygon_count) triangles += uint32_t(polygon.corners()) - 2;
        }
        EXPECT_EQ(own.min, c.bounds.min);
        EXPECT_EQ(own.max, c.bounds.max);
        EXPECT_EQ(triangles, c.triangle_count);
        for (uint32_t v = c.vertex_count; v % 8; ++v) EXPECT_EQ(pointOf(o, c, v), pointOf(o, c, c.vertex_count - 1));
    }
}

/// The records of each polygon run once around it, through its corners and through vertices that lie, exactly, on its
/// sides; and no two open records could have been joined.
inline void expectRightEdges(const Occluder& o) {
    for (const OccluderCluster& c : o.clusters) {
        if (!c.edge_count) continue;
        std::map<std::pair<int, int>, std::vector<int>> next;  // polygon, from: to
        std::map<std::pair<int, int>, int> open;
        size_t records = 0;
        for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e) {
            const OccluderEdge& edge = o.edges[e];
            next[{edge.left, edge.from}].push_back(edge.to);
            if (edge.right != OccluderEdge::kNone) next[{edge.right, edge.to}].push_back(edge.from);
            else ++open[{edge.from, edge.to}];
            records += edge.right != OccluderEdge::kNone ? 2 : 1;
        }
        for (uint32_t p = 0; p < c.polygon_count + c.ring_count; ++p) {
            const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
            for (int k = 0; k < polygon.corners(); ++k) {
                const int from = polygon.vertex[k], to = polygon.vertex[(k + 1) % polygon.corners()];
                for (int at = from; at != to; --records) {
                    const auto& tos = next[{int(p), at}];
                    ASSERT_EQ(tos.size(), 1u);
                    at = tos[0];
                    if (at == to) continue;
                    EXPECT_TRUE(liesBetween(positionOf(o, c, at), positionOf(o, c, from), positionOf(o, c, to)));
                }
            }
        }
        EXPECT_EQ(records, 0u);
        for (const auto& [edge, count] : open) EXPECT_FALSE(open.contains({edge.second, edge.first}));
    }
}

inline void expectOccluderLaws(const Occluder& o) {
    expectWithinLimits(o);
    expectRightEdges(o);
}

}  // namespace sightline
