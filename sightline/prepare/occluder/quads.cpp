// Pairs triangles that share a side into convex, nearly flat quadrangles.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/quads.h"

#include <algorithm>

namespace sightline {
namespace {

constexpr double kFlatness = 1e-4;   // of the longest side
constexpr double kConvexity = 1e-3;  // sine of the least turn at a corner

struct Candidate {
    double length;
    uint32_t a, b;  ///< triangles
    uint8_t side_a, side_b;
};

uint32_t corner(const Patchwork& patchwork, uint32_t triangle, int k) {
    return patchwork.polygons[triangle].vertex[k % 3];
}

/// Whether triangle a with b's far corner beyond a's side makes a convex, flat quadrangle.
bool makesQuad(const Patchwork& patchwork, const Candidate& c) {
    const auto at = [&](uint32_t triangle, int k) {
        return glm::dvec3(patchwork.positions[corner(patchwork, triangle, k)]);
    };
    const glm::dvec3 v[4] = {at(c.a, c.side_a + 1), at(c.a, c.side_a + 2), at(c.a, c.side_a), at(c.b, c.side_b + 2)};
    const glm::dvec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
    const double area = glm::length(n);
    if (!(area > 0.0)) return false;
    if (!isConvex(v, n / area)) return false;
    double longest = 0.0;
    for (int k = 0; k < 4; ++k) longest = std::max(longest, glm::length(v[(k + 1) % 4] - v[k]));
    return std::abs(glm::dot(n, v[3] - v[0])) <= kFlatness * longest * area;
}

std::vector<Candidate> findCandidates(const Patchwork& patchwork) {
    constexpr size_t kMostTried = 4;  // of those that share a side
    std::vector<Candidate> candidates;
    const std::vector<PatchSide> sides = sortedSides(patchwork);
    forSharedSides(std::span(sides), [&](std::span<const PatchSide> shared) {
        const glm::dvec3 along =
            glm::dvec3(patchwork.positions[shared[0].high]) - glm::dvec3(patchwork.positions[shared[0].low]);
        for (size_t i = 0; i < shared.size(); ++i)
            for (size_t j = i + 1; j < std::min(shared.size(), i + kMostTried); ++j) {
                const PatchSide &a = shared[i], &b = shared[j];
                const PatchPolygon &p = patchwork.polygons[a.polygon], &q = patchwork.polygons[b.polygon];
                if (a.forward == b.forward || p.mesh != q.mesh || p.double_sided != q.double_sided) continue;
                const Candidate c{glm::dot(along, along), a.polygon, b.polygon, a.corner, b.corner};
                if (makesQuad(patchwork, c)) candidates.push_back(c);
            }
    });
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
        return p.length != q.length ? p.length > q.length : p.a != q.a ? p.a < q.a : p.b < q.b;
    });
    return candidates;
}

}  // namespace

bool isConvex(const glm::dvec3 (&corners)[4], const glm::dvec3& normal) {
    for (int k = 0; k < 4; ++k) {
        const glm::dvec3 in = corners[(k + 1) % 4] - corners[k], out = corners[(k + 2) % 4] - corners[(k + 1) % 4];
        if (glm::dot(glm::cross(in, out), normal) <= kConvexity * glm::length(in) * glm::length(out)) return false;
    }
    return true;
}

void pairTriangles(Patchwork& patchwork) {
    std::vector<uint8_t> taken(patchwork.polygons.size(), 0);
    std::vector<PatchPolygon> polygons;
    polygons.reserve(patchwork.polygons.size());
    for (const Candidate& c : findCandidates(patchwork)) {
        if (taken[c.a] || taken[c.b]) continue;
        taken[c.a] = taken[c.b] = 1;
        // a runs along the shared side from its side_a to the next corner: the diagonal is next -> ... -> side_a.
        PatchPolygon quad = patchwork.polygons[c.a];
        for (int k = 0; k < 3; ++k) quad.vertex[k] = corner(patchwork, c.a, c.side_a + 1 + k);
        quad.vertex[3] = corner(patchwork, c.b, c.side_b + 2);
        quad.corners = 4;
        polygons.push_back(quad);
    }
    for (size_t triangle = 0; triangle < taken.size(); ++triangle)
        if (!taken[triangle]) polygons.push_back(patchwork.polygons[triangle]);
    std::stable_sort(polygons.begin(), polygons.end(),
                     [](const PatchPolygon& a, const PatchPolygon& b) { return a.mesh < b.mesh; });
    patchwork.polygons = std::move(polygons);
}

}  // namespace sightline
