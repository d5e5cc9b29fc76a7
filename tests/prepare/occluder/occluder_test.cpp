// The laws of preparation: every hiding triangle is kept bit for bit, and pairs are convex and flat.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/occluder.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

using Triangle = std::array<Point, 3>;

/// The same triangle whatever corner it starts at.
Triangle turned(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

std::map<Triangle, int> trianglesOf(const Occluder& o) {
    std::map<Triangle, int> found;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = c.first_polygon; p < c.first_polygon + c.polygon_count; ++p) {
            const uint8_t* v = o.polygons[p].vertex;
            for (int k = 2; k < o.polygons[p].corners(); ++k)
                ++found[turned({pointOf(o, c, v[0]), pointOf(o, c, v[k - 1]), pointOf(o, c, v[k])})];
        }
    return found;
}

/// A grid of quads with a few bumps, so that some pairs are flat and some are not.
Soup makeGrid(uint64_t seed, uint32_t n) {
    Random random(seed);
    Soup soup;
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i)
            soup.positions.push_back({float(i), random.below(4) ? 0.0f : float(random.uniform()), float(j)});
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = j * (n + 1) + i;
            for (uint32_t k : {a, a + n + 1, a + n + 2, a, a + n + 2, a + 1}) soup.indices.push_back(k);
        }
    return soup;
}

TEST(Occluder, KeepsEveryTriangleBitForBit) {
    const Soup soup = makeGrid(1, 40);
    const Occluder occluder = prepareOccluder({soup.positions, soup.indices});
    std::map<Triangle, int> expected;
    for (size_t t = 0; t < soup.indices.size(); t += 3) {
        Triangle triangle;
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = soup.positions[soup.indices[t + k]];
            triangle[k] = {p.x, p.y, p.z};
        }
        ++expected[turned(triangle)];
    }
    EXPECT_EQ(trianglesOf(occluder), expected);
    EXPECT_EQ(occluder.triangleCount(), soup.indices.size() / 3);
    uint32_t quads = 0;
    for (const OccluderPolygon& p : occluder.polygons) quads += p.corners() == 4;
    EXPECT_GT(quads, 300u);
    EXPECT_LT(quads, 1600u);
}

TEST(Occluder, PairsOnlyWhatIsConvexAndFlat) {
    const Soup soup = makeGrid(2, 30);
    const Occluder o = prepareOccluder({soup.positions, soup.indices});
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = c.first_polygon; p < c.first_polygon + c.polygon_count; ++p) {
            if (o.polygons[p].corners() != 4) continue;
            glm::dvec3 v[4];
            for (int k = 0; k < 4; ++k) {
                const auto q = pointOf(o, c, o.polygons[p].vertex[k]);
                v[k] = {q[0], q[1], q[2]};
            }
            const glm::dvec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
            for (int k = 0; k < 4; ++k)
                EXPECT_GT(glm::dot(glm::cross(v[(k + 1) % 4] - v[k], v[(k + 2) % 4] - v[(k + 1) % 4]), n), 0.0);
            EXPECT_LE(std::abs(glm::dot(n, v[3] - v[0])), 2e-4 * glm::length(n));
        }
}

TEST(Occluder, ClustersStayWithinTheirLimitsAndBounds) {
    const Soup soup = makeGrid(3, 100);
    const Occluder o = prepareOccluder({soup.positions, soup.indices});
    EXPECT_GT(o.clusters.size(), 50u);
    expectWithinLimits(o);
}

TEST(Occluder, LeavesOutWhatDoesNotHideAndWhatIsBroken) {
    Soup soup;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {0, 0, 0}};
    soup.indices = {0, 1, 2, 0, 1, 3, 0, 4, 1, 0, 1, 9, 1, 2, 0};
    const std::vector<uint8_t> hides{1, 1, 1, 1, 0};
    EXPECT_EQ(prepareOccluder({soup.positions, soup.indices}, hides).triangleCount(), 1u);
    EXPECT_TRUE(prepareOccluder({}).clusters.empty());
}

TEST(Occluder, TakesPositionsOfAnySize) {
    constexpr float kPlaces[] = {
        0,      -0.0f,  1,       -1,     2,       0.1f,     3e38f,
        -3e38f, 1e-45f, -1e-45f, 1e-38f, 0x1p60f, 0x1p-60f, std::numeric_limits<float>::infinity()};
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Soup soup;
        for (int i = 0; i < 25; ++i) {
            const float x = kPlaces[random.below(14)], y = kPlaces[random.below(14)];
            soup.positions.push_back({x, y, kPlaces[random.below(14)]});
        }
        for (int i = 0; i < 3 * 400; ++i) soup.indices.push_back(uint32_t(random.below(26)));
        std::vector<uint8_t> double_sided(400);
        for (uint8_t& both : double_sided) both = uint8_t(random.below(2));
        const Occluder o = prepareOccluder(soup.view(), {}, double_sided, {.rings = true, .merge = true});
        expectOccluderLaws(o);
    }
}

}  // namespace
}  // namespace sightline
