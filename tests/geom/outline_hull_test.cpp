// Convex hulls of points in a plane, against their definition.
// SPDX-License-Identifier: MIT
#include "sightline/geom/outline_hull.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
namespace {

TEST(OutlineHull, HoldsAllPointsAndTurnsOneWay) {
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
        const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.7))), v = glm::cross(normal, u);
        std::vector<glm::dvec3> points;
        const uint64_t count = 3 + random.below(30);
        // Every other time on a lattice: many points in lines, and twice.
        for (uint64_t i = 0; i < count; ++i) {
            const double x = seed % 2 ? random.uniform(-1, 1) : static_cast<double>(random.below(4));
            const double y = seed % 2 ? random.uniform(-1, 1) : static_cast<double>(random.below(4));
            points.push_back(x * u + y * v);
        }
        const std::vector<glm::dvec3> hull = outlineHull(points, normal);
        if (hull.size() < 3) continue;
        for (size_t i = 0; i < hull.size(); ++i) {
            const glm::dvec3 &a = hull[i], &b = hull[(i + 1) % hull.size()], &c = hull[(i + 2) % hull.size()];
            EXPECT_NE(std::find(points.begin(), points.end(), a), points.end()) << seed;
            EXPECT_GT(glm::dot(normal, glm::cross(b - a, c - b)), -1e-12) << seed;
            for (const glm::dvec3& point : points)
                EXPECT_GE(glm::dot(normal, glm::cross(b - a, point - a)), -1e-12) << seed;
        }
    }
}

TEST(OutlineHull, OfFewOrOfALineHasNoArea) {
    const glm::dvec3 up(0, 1, 0);
    EXPECT_TRUE(outlineHull({}, up).empty());
    const std::vector<glm::dvec3> line = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    EXPECT_LT(outlineHull(line, up).size(), 3u);
    const std::vector<glm::dvec3> square = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0.5, 0, 0.5}};
    EXPECT_EQ(outlineHull(square, up).size(), 4u);
    EXPECT_EQ(outlineHull(square, -up).size(), 4u);
}

}  // namespace
}  // namespace sightline
