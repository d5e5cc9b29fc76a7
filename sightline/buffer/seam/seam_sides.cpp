// Which sides of polygons are the same edge of the world: exactly, by their vertices and their objects' transforms.
// SPDX-License-Identifier: MIT
#include <cstring>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/buffer/seam/seam.h"

namespace sightline {
namespace {

struct Point {
    float x, y, z;
    bool operator==(const Point&) const = default;
};

uint64_t hashPoint(const Point& p, uint64_t seed) {
    uint32_t bits[3];
    std::memcpy(bits, &p, sizeof bits);
    uint64_t h = seed;
    for (uint32_t b : bits) h = (h ^ b) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return h;
}

bool less(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

Point meshPoint(const DrawnCluster& drawn, uint8_t vertex) {
    const Occluder& o = *drawn.occluder;
    SIGHTLINE_DEBUG_ASSERT(vertex < o.clusters[drawn.cluster].vertex_count);
    const size_t at = size_t{o.clusters[drawn.cluster].first_vertex} + vertex;
    return {o.x[at], o.y[at], o.z[at]};
}

/// The mesh edge that a side lies on.
void edgeOf(const DepthTiles& tiles, const SeamPolygon& polygon, int side, Point& from, Point& to) {
    SIGHTLINE_DEBUG_ASSERT(polygon.drawn < tiles.drawn.size());
    SIGHTLINE_DEBUG_ASSERT(side >= 0 && side < polygon.corners);
    const DrawnCluster& drawn = tiles.drawn[polygon.drawn];
    if (polygon.clipped != SeamPolygon::kWhole) {
        const ClippedPolygon& clipped = tiles.clipped[polygon.clipped];
        from = meshPoint(drawn, clipped.from[side]);
        to = meshPoint(drawn, clipped.to[side]);
        return;
    }
    from = meshPoint(drawn, polygon.vertex[side]);
    to = meshPoint(drawn, polygon.vertex[side + 1 < polygon.corners ? side + 1 : 0]);
}

bool sameTransform(const DrawnCluster& a, const DrawnCluster& b) {
    SIGHTLINE_DEBUG_ASSERT(a.transform != nullptr && b.transform != nullptr);
    return a.transform == b.transform ||
           (a.transform_hash == b.transform_hash && std::memcmp(a.transform, b.transform, sizeof *a.transform) == 0);
}

}  // namespace

bool areOpposite(const DepthTiles& tiles, const SeamPolygon& a, int side_a, const SeamPolygon& b, int side_b) {
    Point from_a, to_a, from_b, to_b;
    edgeOf(tiles, a, side_a, from_a, to_a);
    edgeOf(tiles, b, side_b, from_b, to_b);
    return from_a == to_b && to_a == from_b && sameTransform(tiles.drawn[a.drawn], tiles.drawn[b.drawn]);
}

void setSideKeys(const DepthTiles& tiles, SeamPolygon& polygon) {
    if (polygon.keyed) return;
    polygon.keyed = true;
    for (int i = 0; i < polygon.corners; ++i) {
        if (polygon.open >> i & 1) continue;
        Point from, to;
        edgeOf(tiles, polygon, i, from, to);
        const bool forward = less(from, to);
        if (forward) polygon.forward |= static_cast<uint8_t>(1u << i);
        else std::swap(from, to);
        polygon.side_key[i] = hashPoint(to, hashPoint(from, tiles.drawn[polygon.drawn].transform_hash));
    }
}

bool findSharedSide(const DepthTiles& tiles, const SeamPolygon& a, const SeamPolygon& b, int& side_a, int& side_b) {
    if (!(a.edge_bits & b.edge_bits)) return false;
    SIGHTLINE_DEBUG_ASSERT(a.raster.complete && b.raster.complete);
    SIGHTLINE_DEBUG_ASSERT(a.raster.edges == a.corners && b.raster.edges == b.corners);
    for (int i = 0; i < a.raster.edges; ++i) {
        if (a.open >> i & 1) continue;
        const EdgeFunction& one = a.raster.edge[i];
        for (int j = 0; j < b.raster.edges; ++j) {
            const EdgeFunction& other = b.raster.edge[j];
            if (a.edge_key[i] != b.edge_key[j] || (b.open >> j & 1)) continue;
            if (one.a != -other.a || one.b != -other.b || one.c != -other.c || !areOpposite(tiles, a, i, b, j))
                continue;
            side_a = i;
            side_b = j;
            return true;
        }
    }
    return false;
}

}  // namespace sightline
