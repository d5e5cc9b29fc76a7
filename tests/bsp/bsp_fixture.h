// Polygons for the laws of BSP trees, and checks that any tree must pass.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bsp/bsp.h"
#include "sightline/bsp/bsp_piece.h"
#include "sightline/bsp/bsp_walk.h"
#include "tests/support/random.h"

namespace sightline::test {

/// Triangles of any size up to `size` around centres in a cube of half side 1.
inline BspPolygons randomTriangles(uint64_t seed, uint32_t count, double size, uint32_t first_number = 0) {
    Random random(seed);
    BspPolygons polygons;
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 center = randomVector(random, 1);
        const glm::dvec3 p[3] = {center + randomVector(random, size), center + randomVector(random, size),
                                 center + randomVector(random, size)};
        polygons.add(p, first_number + i);
    }
    return polygons;
}

/// Sizes as of a sphere: every face's plane has all others behind it.
inline BspPolygons convexFaces(uint32_t rings, const glm::dvec3& center = glm::dvec3(0.0), double radius = 1,
                               uint32_t first_number = 0) {
    BspPolygons polygons;
    const uint32_t sectors = 2 * rings;
    const auto at = [&](uint32_t ring, uint32_t sector) {
        const double theta = M_PI * ring / rings, phi = 2 * M_PI * (sector % sectors) / sectors;
        if (ring == 0) return center + glm::dvec3(0, radius, 0);
        if (ring == rings) return center - glm::dvec3(0, radius, 0);
        return center +
               radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t sector = 0; sector < sectors; ++sector) {
            const glm::dvec3 a = at(ring, sector), b = at(ring + 1, sector), c = at(ring + 1, sector + 1),
                             d = at(ring, sector + 1);
            const glm::dvec3 lower[3] = {a, c, b}, upper[3] = {a, d, c};
            if (ring + 1 < rings) polygons.add(lower, first_number + static_cast<uint32_t>(polygons.size()));
            if (ring > 0) polygons.add(upper, first_number + static_cast<uint32_t>(polygons.size()));
            if (ring + 1 == rings) continue;
        }
    return polygons;
}

/// Duplicates, stacks in a plane, slivers, lines, points, numbers that are none, all in the same place.
inline BspPolygons degenerateMix(uint64_t seed, uint32_t count) {
    Random random(seed);
    BspPolygons polygons;
    for (uint32_t i = 0; i < count; ++i) {
        glm::dvec3 p[3] = {randomVector(random, 1), randomVector(random, 1), randomVector(random, 1)};
        const uint64_t kind = random.below(9);
        if (kind == 0) p[2] = p[1];
        if (kind == 1) p[1] = p[2] = p[0];
        if (kind == 2) p[2] = 0.5 * (p[0] + p[1]) + 1e-9 * p[2];
        if (kind == 3) p[2] = 0.5 * (p[0] + p[1]) + 1e-15 * p[2];
        if (kind == 4) p[0].y = p[1].y = p[2].y = 0.25;
        if (kind == 5) p[0].y = p[1].y = p[2].y = 0.25 + 1e-13 * random.uniform();
        if (kind == 6 && random.below(4) == 0) p[random.below(3)].x = std::nan("");
        if (kind == 7 && polygons.size() > 0) {
            const std::span<const glm::dvec3> other = polygons.outline(random.below(polygons.size()));
            std::copy(other.begin(), other.end(), p);
            if (random.below(2)) std::swap(p[0], p[1]);
        }
        if (kind == 8)
            for (glm::dvec3& v : p) v = glm::round(2.0 * v) / 2.0;
        polygons.add(p, i);
    }
    return polygons;
}

inline double areaOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 sum(0.0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        sum += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return 0.5 * glm::length(sum);
}

inline std::map<uint32_t, double> areasOf(const BspPolygons& polygons) {
    std::map<uint32_t, double> areas;
    for (size_t i = 0; i < polygons.size(); ++i)
        if (planeOf(polygons.outline(i))) areas[polygons.number[i]] += areaOf(polygons.outline(i));
    return areas;
}

inline void addAreas(const BspArrays& arrays, std::span<const BspPiece> pieces, std::map<uint32_t, double>& areas) {
    for (const BspPiece& piece : pieces) areas[piece.number] += areaOf(arrays.outline(piece));
}

inline void expectSameAreas(const std::map<uint32_t, double>& expected, const std::map<uint32_t, double>& found) {
    double sum = 0, sum_found = 0;
    for (const auto& [number, area] : expected) {
        const auto at = found.find(number);
        ASSERT_TRUE(at != found.end()) << "polygon " << number << " is lost";
        ASSERT_NEAR(at->second, area, 1e-6 * (area + 1e-6)) << "polygon " << number;
        sum += area;
        sum_found += at->second;
    }
    EXPECT_EQ(expected.size(), found.size());
    EXPECT_NEAR(sum_found, sum, 1e-9 * sum);
}

/// Links, bounds, counts, lists and the sides of all pieces.
inline void expectSound(const BspTree& tree, const BspPolygons& input) {
    std::map<uint32_t, double> areas;
    std::vector<uint32_t> below(tree.nodes.size(), 0);
    size_t leaves = 0;
    for (uint32_t n = static_cast<uint32_t>(tree.nodes.size()); n-- > 0;) {
        const BspNode& node = tree.nodes[n];
        ASSERT_NEAR(glm::length(glm::dvec3(node.plane)), 1, 1e-12);
        addAreas(tree, tree.piecesOf(node), areas);
        below[n] += node.count;
        for (uint32_t side = 0; side < 2; ++side) {
            if ((node.child[side] & BspNode::kLeaf) != 0) {
                ASSERT_EQ(tree.leaf[node.child[side] & ~BspNode::kLeaf], n << 1 | side);
                ++leaves;
            } else {
                ASSERT_GT(node.child[side], n);
                ASSERT_EQ(tree.parent[node.child[side]], n << 1 | side);
            }
        }
        ASSERT_EQ(below[n], tree.below[n]);
        const uint32_t parent = tree.parent[n];
        if (parent != BspNode::kNone) below[parent >> 1] += below[n];
        uint32_t last = 0;
        for (const BspPiece& piece : tree.piecesOf(node)) {
            ASSERT_GE(piece.number, last);
            last = piece.number;
            ASSERT_GE(piece.count, 3u);
            for (const glm::dvec3& p : tree.outline(piece)) {
                ASSERT_LE(std::abs(distanceTo(node.plane, p)), 2 * tree.thickness);
                for (uint32_t slot = n << 1; slot != BspNode::kNone; slot = tree.parent[slot >> 1]) {
                    const Box3d& box = tree.bounds[slot >> 1];
                    for (int axis = 0; axis < 3; ++axis)
                        ASSERT_TRUE(p[axis] >= box.min[axis] && p[axis] <= box.max[axis]);
                    if (slot >> 1 == n) continue;
                    const double d = distanceTo(tree.nodes[slot >> 1].plane, p);
                    ASSERT_TRUE((slot & 1) == kBspFront ? d >= -2 * tree.thickness : d <= 2 * tree.thickness)
                        << "node " << n << " at " << d << " of node " << (slot >> 1);
                }
            }
            for (uint32_t cut = piece.cut; cut != BspNode::kNone; cut = tree.cuts[cut].before) {
                const glm::dvec4& plane = tree.nodes[tree.cuts[cut].node].plane;
                for (const glm::dvec3& p : tree.outline(piece)) {
                    const double d = distanceTo(plane, p);
                    ASSERT_TRUE(tree.cuts[cut].side == kBspFront ? d >= -2 * tree.thickness : d <= 2 * tree.thickness);
                }
            }
        }
    }
    ASSERT_EQ(leaves, tree.nodes.empty() ? 0u : tree.leaf.size());
    expectSameAreas(areasOf(input), areas);
}

/// What a walk visits, in order.
struct Seen {
    std::span<const glm::dvec3> outline;
    uint32_t order = 0;
};

/// Where a ray meets a convex polygon: its parameter, or infinity; NaN if that is too close to call.
inline double meets(const glm::dvec3& origin, const glm::dvec3& direction, std::span<const glm::dvec3> outline) {
    const std::optional<glm::dvec4> plane = planeOf(outline);
    if (!plane) return std::nan("");
    const double along = glm::dot(glm::dvec3(*plane), direction);
    if (std::abs(along) < 1e-4) return std::nan("");
    const double t = -distanceTo(*plane, origin) / along;
    if (t < 1e-6) return std::numeric_limits<double>::infinity();
    const glm::dvec3 p = origin + t * direction;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3& a = outline[i];
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - a;
        const double length = glm::length(edge);
        if (length < 1e-12) continue;
        const double side = glm::dot(glm::cross(edge, p - a), glm::dvec3(*plane)) / length;
        if (side < -1e-9) return std::numeric_limits<double>::infinity();
        if (side < 1e-9) return std::nan("");
    }
    return t;
}

/// Casts rays: of two things that one ray meets, the one seen later must not be behind. Counts the pairs.
template <class RayOf>
uint64_t expectBackToFront(const std::vector<Seen>& seen, int rays, RayOf&& rayOf, const std::string& what) {
    uint64_t pairs = 0;
    for (int ray = 0; ray < rays; ++ray) {
        const auto [origin, direction] = rayOf(ray);
        double nearest = std::numeric_limits<double>::infinity();
        uint32_t nearest_order = 0;
        for (const Seen& one : seen) {
            const double t = meets(origin, direction, one.outline);
            if (!std::isfinite(t)) continue;
            pairs += nearest < std::numeric_limits<double>::infinity();
            EXPECT_LE(t, nearest + 1e-9) << what << ", ray " << ray << ": visited as number " << one.order
                                         << " but behind number " << nearest_order;
            if (t > nearest + 1e-9) return pairs;
            nearest = std::min(nearest, t);
            nearest_order = one.order;
        }
    }
    return pairs;
}

}  // namespace sightline::test
