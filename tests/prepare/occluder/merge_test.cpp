// The laws of merging: exactly the same points are covered, in the same plane, by fewer polygons.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/merge.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "sightline/prepare/occluder/quads.h"
#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

/// A rectangle of cells, of which some are missing; cell (i, j) lies between the i-th and (i+1)-th place. Each cell is
/// two triangles, along one diagonal or the other.
Soup makeWall(Random& random, const std::vector<float>& xs, const std::vector<float>& ys, uint64_t holes,
              glm::vec3 right, glm::vec3 up) {
    Soup soup;
    for (size_t j = 0; j + 1 < ys.size(); ++j)
        for (size_t i = 0; i + 1 < xs.size(); ++i) {
            if (holes && random.below(holes) == 0) continue;
            const auto at = [&](size_t a, size_t b) { return xs[a] * right + ys[b] * up; };
            const glm::vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (random.below(2)) soup.add({a, b, c, d});
            else soup.add({b, c, d, a});
        }
    return soup;
}

std::vector<float> places(Random& random, int count, bool even) {
    std::vector<float> out{0};
    for (int i = 0; i < count; ++i) out.push_back(out.back() + (even ? 1.0f : float(1 + random.below(5)) * 0.25f));
    return out;
}

uint32_t polygonsOf(const Occluder& o) {
    uint32_t count = 0;
    for (const OccluderCluster& c : o.clusters) count += c.polygon_count;
    return count;
}

/// How often the polygons of one facing cover a point of a wall in the plane of right and up, by exact corners.
int coverOf(const Occluder& o, glm::vec3 right, glm::vec3 up, double x, double y) {
    int covers = 0;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = 0; p < c.polygon_count; ++p) {
            const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
            bool inside = true;
            for (int k = 0; k < polygon.corners(); ++k) {
                const auto at = [&](int i) {
                    const glm::dvec3 q(positionOf(o, c, polygon.vertex[i % polygon.corners()]));
                    return glm::dvec2(glm::dot(q, glm::dvec3(right)) / glm::dot(right, right),
                                      glm::dot(q, glm::dvec3(up)) / glm::dot(up, up));
                };
                const glm::dvec2 a = at(k), b = at(k + 1);
                inside = inside && (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0;
            }
            covers += inside;
        }
    return covers;
}

TEST(Merge, AWallOfRectanglesBecomesOne) {
    Random random(1);
    for (int n : {1, 2, 3, 5, 8, 13, 40})
        for (const auto& [right, up] :
             {std::pair{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}, {glm::vec3(4, 3, 1), glm::vec3(-3, 4, 0)}}) {
            SCOPED_TRACE(n);
            const std::vector<float> xs = places(random, n, true), ys = places(random, n + n / 3, true);
            const Soup soup = makeWall(random, xs, ys, 0, right, up);
            const Occluder o = prepareOccluder(soup.view(), {}, {}, {.merge = true});
            EXPECT_EQ(polygonsOf(o), 1u);
            const std::set<Point> corners(
                {Point{0, 0, 0}, Point{xs.back() * right.x, xs.back() * right.y, xs.back() * right.z}});
            const Corners found = cornersOf(o, o.clusters[0], 0);
            EXPECT_EQ(found.size(), 4u);
            for (const Point& corner : corners) EXPECT_EQ(std::count(found.begin(), found.end(), corner), 1);
        }
}

TEST(Merge, CoversTheSamePointsAsOften) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const glm::vec3 right(4, 3, 1), up(-3, 4, 0);
        const std::vector<float> xs = places(random, 14, false), ys = places(random, 11, seed % 2);
        const Soup soup = makeWall(random, xs, ys, 5, right, up);
        const Occluder before = prepareOccluder(soup.view(), {}, {}, {.rings = true});
        const Occluder after = prepareOccluder(soup.view(), {}, {}, {.rings = true, .merge = true});
        expectOccluderLaws(after);
        EXPECT_LT(2 * polygonsOf(after), polygonsOf(before));
        for (int i = 0; i < 2000; ++i) {
            const double x = random.uniform(0, xs.back()), y = random.uniform(0, ys.back());
            ASSERT_EQ(coverOf(before, right, up, x, y), coverOf(after, right, up, x, y)) << x << ' ' << y;
        }
        // What the merged polygons leave between them is closed again by parts of edges: only the rim of the wall and
        // of its holes is open.
        double open[2] = {0, 0};
        for (const Occluder* o : {&before, &after})
            for (const OccluderCluster& c : o->clusters)
                for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e)
                    if (o->edges[e].right == OccluderEdge::kNone && o->edges[e].left < c.polygon_count)
                        open[o == &after] += glm::distance(glm::dvec3(positionOf(*o, c, o->edges[e].from)),
                                                           glm::dvec3(positionOf(*o, c, o->edges[e].to)));
        EXPECT_GT(open[1], 0);
        EXPECT_NEAR(open[1], open[0], 1e-6 * open[0]);
    }
}

TEST(Merge, KeepsPlaneFacingAndArea) {
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Soup soup;  // boxes whose faces are tessellated, some sides shared between boxes
        std::vector<uint8_t> double_sided;
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 a(float(random.below(9)), float(random.below(9)), float(random.below(9)));
            soup.addBox(a, a + glm::vec3(1 + random.below(3), 1 + random.below(3), 1 + random.below(3)));
            double_sided.resize(soup.indices.size() / 3, uint8_t(random.below(2)));
        }
        // Area by plane (axis, place), direction and kind.
        const auto areas = [&](bool merge) {
            const Occluder o = prepareOccluder(soup.view(), {}, double_sided, {.rings = true, .merge = merge});
            expectOccluderLaws(o);
            std::map<std::tuple<int, float, bool, bool>, double> found;
            for (const OccluderCluster& c : o.clusters)
                for (uint32_t p = 0; p < c.polygon_count; ++p) {
                    const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
                    const auto at = [&](int k) { return positionOf(o, c, polygon.vertex[k]); };
                    for (int k = 2; k < polygon.corners(); ++k) {
                        const glm::vec3 n = glm::cross(at(k - 1) - at(0), at(k) - at(0));
                        const int axis = n.x != 0 ? 0 : n.y != 0 ? 1 : 2;
                        EXPECT_EQ(n[(axis + 1) % 3], 0);
                        EXPECT_EQ(n[(axis + 2) % 3], 0);
                        found[{axis, at(0)[axis], n[axis] > 0, polygon.double_sided}] += 0.5 * std::abs(n[axis]);
                    }
                }
            return found;
        };
        EXPECT_EQ(areas(true), areas(false));
    }
}

TEST(Merge, LeavesWhatIsNotExactlyFlat) {
    Random random(3);
    Soup soup = makeWall(random, places(random, 4, true), places(random, 4, true), 0, {1, 0, 0}, {0, 1, 0});
    for (glm::vec3& p : soup.positions)
        if (p.x == 2 && p.y == 2) p.z = 0x1p-20f;
    const Occluder o = prepareOccluder(soup.view(), {}, {}, {.merge = true});
    EXPECT_GE(polygonsOf(o), 8u);  // four cells around the middle stay, pairs or triangles
    EXPECT_LT(polygonsOf(o), 16u);
    std::set<Point> corners;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = 0; p < c.polygon_count; ++p)
            for (const Point& q : cornersOf(o, c, p)) corners.insert(q);
    EXPECT_TRUE(corners.contains(Point{2, 2, 0x1p-20f}));
    EXPECT_FALSE(corners.contains(Point{2, 0, 0}));
}

TEST(Merge, KeepsMeshesApartUnlessTheyAreJoined) {
    std::vector<Soup> panels;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
            panels.emplace_back().add({{i, j, 0}, {i + 1, j, 0}, {i + 1, j + 1, 0}, {i, j + 1, 0}});
    std::vector<OccluderSource> sources;
    for (const Soup& soup : panels) sources.push_back({soup.view(), {}, {}});
    EXPECT_EQ(polygonsOf(prepareJoined(sources, {.merge = true})), 1u);
    for (const Occluder& o : prepareOccluders(sources, {.merge = true})) EXPECT_EQ(polygonsOf(o), 1u);
}

TEST(Merge, IsTheSameEachTime) {
    Random random(9);
    const Soup soup = makeWall(random, places(random, 30, false), places(random, 30, false), 6, {1, 0, 0}, {0, 1, 0});
    const Occluder a = prepareOccluder(soup.view(), {}, {}, {.rings = true, .merge = true});
    const Occluder b = prepareOccluder(soup.view(), {}, {}, {.rings = true, .merge = true});
    ASSERT_EQ(a.polygons.size(), b.polygons.size());
    ASSERT_EQ(a.edges.size(), b.edges.size());
    EXPECT_EQ(0, std::memcmp(a.polygons.data(), b.polygons.data(), a.polygons.size() * sizeof(OccluderPolygon)));
    EXPECT_EQ(0, std::memcmp(a.edges.data(), b.edges.data(), a.edges.size() * sizeof(OccluderEdge)));
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
    EXPECT_EQ(a.z, b.z);
}

}  // namespace
}  // namespace sightline
