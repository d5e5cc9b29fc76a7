// Pairs triangles that share an edge into convex, nearly flat quadrangles.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/quads.h"

#include <algorithm>
#include <tuple>

namespace sightline {
namespace {

constexpr double kFlatness = 1e-4;   // of the longest side
constexpr double kConvexity = 1e-3;  // sine of the least turn at a corner

using Key = std::tuple<float, float, float, float, float, float>;

struct HalfEdge {
    Key key;  ///< both directions have the same
    uint32_t triangle;
    uint8_t side;
    bool forward;
};

struct Candidate {
    double length;
    uint32_t a, b;  ///< triangles
    uint8_t side_a, side_b;
};

glm::vec3 corner(const MeshView& mesh, uint32_t triangle, int k) {
    return mesh.positions[mesh.indices[3 * size_t{triangle} + static_cast<size_t>(k % 3)]] + glm::vec3(0.0f);
}

HalfEdge halfEdge(const MeshView& mesh, uint32_t triangle, uint8_t side) {
    glm::vec3 p = corner(mesh, triangle, side), q = corner(mesh, triangle, side + 1);
    const bool forward = std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
    if (!forward) std::swap(p, q);
    return {{p.x, p.y, p.z, q.x, q.y, q.z}, triangle, side, forward};
}

/// Whether triangle a with b's far corner beyond a's side makes a convex, flat quadrangle.
bool makesQuad(const MeshView& mesh, const Candidate& c) {
    const glm::dvec3 v[4] = {corner(mesh, c.a, c.side_a + 1), corner(mesh, c.a, c.side_a + 2),
                             corner(mesh, c.a, c.side_a), corner(mesh, c.b, c.side_b + 2)};
    const glm::dvec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
    const double area = glm::length(n);
    if (!(area > 0.0)) return false;
    double longest = 0.0;
    for (int k = 0; k < 4; ++k) {
        const glm::dvec3 in = v[(k + 1) % 4] - v[k], out = v[(k + 2) % 4] - v[(k + 1) % 4];
        longest = std::max(longest, glm::length(in));
        if (glm::dot(glm::cross(in, out), n) <= kConvexity * glm::length(in) * glm::length(out) * area) return false;
    }
    return std::abs(glm::dot(n, v[3] - v[0])) <= kFlatness * longest * area;
}

std::vector<Candidate> findCandidates(const MeshView& mesh, std::span<const uint32_t> triangles,
                                      std::span<const uint8_t> kind) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles.size());
    for (uint32_t triangle : triangles)
        for (uint8_t side = 0; side < 3; ++side) edges.push_back(halfEdge(mesh, triangle, side));
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return a.key != b.key ? a.key < b.key : a.triangle != b.triangle ? a.triangle < b.triangle : a.side < b.side;
    });
    std::vector<Candidate> candidates;
    for (size_t i = 0; i < edges.size(); ++i) {
        for (size_t j = i + 1; j < edges.size() && j < i + 4 && edges[j].key == edges[i].key; ++j) {
            const HalfEdge &a = edges[i], &b = edges[j];
            if (a.forward == b.forward || a.triangle == b.triangle) continue;
            if (!kind.empty() && kind[a.triangle] != kind[b.triangle]) continue;
            const glm::dvec3 along =
                glm::dvec3(corner(mesh, a.triangle, a.side + 1) - corner(mesh, a.triangle, a.side));
            Candidate c{glm::dot(along, along), a.triangle, b.triangle, a.side, b.side};
            if (makesQuad(mesh, c)) candidates.push_back(c);
        }
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
        return p.length != q.length ? p.length > q.length : p.a != q.a ? p.a < q.a : p.b < q.b;
    });
    return candidates;
}

}  // namespace

std::vector<MeshPolygon> pairTriangles(const MeshView& mesh, std::span<const uint32_t> triangles,
                                       std::span<const uint8_t> kind) {
    std::vector<uint8_t> taken(mesh.triangles(), 0);
    std::vector<MeshPolygon> polygons;
    polygons.reserve(triangles.size());
    const auto index = [&](uint32_t triangle, int k) { return mesh.indices[3 * size_t{triangle} + size_t(k % 3)]; };
    for (const Candidate& c : findCandidates(mesh, triangles, kind)) {
        if (taken[c.a] || taken[c.b]) continue;
        taken[c.a] = taken[c.b] = 1;
        // a runs along the shared side from its side_a to the next corner: the diagonal is next -> ... -> side_a.
        polygons.push_back(
            {{index(c.a, c.side_a + 1), index(c.a, c.side_a + 2), index(c.a, c.side_a), index(c.b, c.side_b + 2)},
             c.a,
             4});
    }
    for (uint32_t triangle : triangles)
        if (!taken[triangle])
            polygons.push_back({{index(triangle, 0), index(triangle, 1), index(triangle, 2), 0}, triangle, 3});
    return polygons;
}

}  // namespace sightline
