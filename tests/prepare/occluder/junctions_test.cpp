// The laws of T-junctions: found where a vertex lies exactly on a side, and nowhere else; brick walls hang together.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/junctions.h"

#include <gtest/gtest.h>

#include <set>

#include "sightline/prepare/occluder/quads.h"
#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

/// Against brute force: what lies on a side that has no partner, among the ends of such sides, is in its chain.
void expectChains(const Patchwork& before, const Patchwork& after) {
    const std::vector<PatchSide> sides = sortedSides(before);
    std::vector<PatchSide> open;
    forSharedSides(std::span(sides), [&](std::span<const PatchSide> shared) {
        size_t forward = 0;
        for (const PatchSide& side : shared) forward += side.forward;
        if (2 * forward != shared.size()) open.insert(open.end(), shared.begin(), shared.end());
    });
    std::set<uint32_t> ends;
    for (const PatchSide& side : open) ends.insert({side.low, side.high});
    for (const PatchSide& side : open) {
        const std::span<const uint32_t> chain = after.chain(side.polygon, side.corner);
        const std::set<uint32_t> found(chain.begin(), chain.end());
        for (uint32_t end : ends)
            if (liesBetween(before.positions[end], before.positions[side.low], before.positions[side.high])) {
                EXPECT_TRUE(found.contains(end));
            }
    }
    for (uint32_t p = 0; p < after.polygons.size(); ++p)
        for (int k = 0; k < after.polygons[p].corners; ++k) {
            const PatchPolygon& polygon = after.polygons[p];
            const glm::vec3 to = after.positions[polygon.vertex[(k + 1) % polygon.corners]];
            glm::vec3 from = after.positions[polygon.vertex[k]];
            for (uint32_t vertex : after.chain(p, k)) {
                EXPECT_TRUE(liesBetween(after.positions[vertex], from, to));
                from = after.positions[vertex];
            }
        }
}

TEST(Junctions, AreFoundWhereAVertexLiesOnASide) {
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Soup soup;  // on a small lattice, where many vertices lie on sides of others
        const auto at = [&] {
            const float x = float(random.below(7)), y = float(random.below(7));
            return glm::vec3(x, y, float(random.below(3)));
        };
        for (int i = 0; i < 60; ++i) {
            const glm::vec3 a = at(), b = at();
            soup.add({a, b, at()});
        }
        const OccluderSource source{soup.view(), {}, {}};
        Patchwork patchwork = weld({&source, 1});
        pairTriangles(patchwork);
        const Patchwork before = patchwork;
        findJunctions(patchwork);
        EXPECT_FALSE(patchwork.chains.empty());
        expectChains(before, patchwork);
        const Occluder o = prepareOccluder(soup.view(), {}, {}, {.rings = true});
        expectOccluderLaws(o);
    }
}

/// A wall of courses in running bond, each brick's panel a mesh of its own; origin + i * right + j * up.
std::vector<Soup> makeBricks(int courses, int bricks, glm::vec3 right, glm::vec3 up) {
    std::vector<Soup> out;
    for (int j = 0; j < courses; ++j)
        for (int i = 0; i < bricks; ++i) {
            const float x = float(2 * i + j % 2), y = float(j);
            out.emplace_back().add({x * right + y * up, (x + 2) * right + y * up, (x + 2) * right + (y + 1) * up,
                                    x * right + (y + 1) * up});
        }
    return out;
}

/// Open edges of polygons that are a cluster's own, that do not lie on the wall's rim.
uint32_t openInside(const Occluder& o, int courses, int bricks, glm::vec3 right, glm::vec3 up) {
    uint32_t count = 0;
    const glm::dvec3 r(right), u(up);
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e) {
            const OccluderEdge& edge = o.edges[e];
            if (edge.right != OccluderEdge::kNone || edge.left >= c.polygon_count) continue;
            const auto heightOf = [&](uint8_t v) {
                return glm::dot(glm::dvec3(positionOf(o, c, v)), u) / glm::dot(u, u);
            };
            const auto alongOf = [&](uint8_t v) {
                return glm::dot(glm::dvec3(positionOf(o, c, v)), r) / glm::dot(r, r);
            };
            const double x = 0.5 * (alongOf(edge.from) + alongOf(edge.to)),
                         y = 0.5 * (heightOf(edge.from) + heightOf(edge.to));
            count += x > 1.01 && x < 2 * bricks - 0.01 && y > 0.01 && y < courses - 0.01;
        }
    return count;
}

TEST(Junctions, ABrickBondHangsTogether) {
    constexpr int kCourses = 20, kBricks = 40;
    for (const auto& [right, up] : {std::pair{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)},
                                    {glm::vec3(4, 3, 1), glm::vec3(-3, 4, 0)},
                                    {glm::vec3(0.7f, 0, 0), glm::vec3(0, 0, 0.3f)}}) {
        const std::vector<Soup> bricks = makeBricks(kCourses, kBricks, right, up);
        const Occluder joined = prepareJoined(sourcesOf(bricks), {.rings = true});
        expectOccluderLaws(joined);
        EXPECT_LE(joined.clusters.size(), 16u);  // of 800 panels
        uint32_t own = 0;
        for (const OccluderCluster& c : joined.clusters) own += c.polygon_count;
        EXPECT_EQ(own, uint32_t(kCourses * kBricks));
        EXPECT_EQ(openInside(joined, kCourses, kBricks, right, up), 0u);

        const std::vector<Occluder> each = prepareOccluders(sourcesOf(bricks), {.rings = true});
        ASSERT_EQ(each.size(), bricks.size());
        for (const Occluder& o : each) {
            expectOccluderLaws(o);
            ASSERT_EQ(o.clusters.size(), 1u);
            EXPECT_EQ(o.clusters[0].polygon_count, 1u);
            EXPECT_EQ(openInside(o, kCourses, kBricks, right, up), 0u);
        }
    }
}

TEST(Junctions, AGapOfOneStepOfTheLastPlaceStaysOpen) {
    std::vector<Soup> bricks = makeBricks(2, 1, {1, 0, 0}, {0, 1, 0});
    for (glm::vec3& p : bricks[1].positions) p.y = std::nextafter(p.y, 10.0f);
    for (const Occluder& o : prepareOccluders(sourcesOf(bricks), {.rings = true}))
        EXPECT_EQ(o.clusters[0].edge_count, 0u);
}

TEST(Junctions, BoxesInABondMakeOneWall) {
    // Closed boxes: each side has its partner in its own box, and yet the fronts go on in each other.
    Soup soup;
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) soup.addBox({2 * i + j % 2, j, 0}, {2 * i + 2 + j % 2, j + 1, 1});
    const Occluder o = prepareOccluder(soup.view(), {}, {}, {.rings = true});
    expectOccluderLaws(o);
    uint32_t fronts = 0;
    for (const OccluderCluster& c : o.clusters) {
        const auto isFront = [&](uint8_t p) {
            for (int k = 0; k < 4; ++k)
                if (positionOf(o, c, o.polygons[c.first_polygon + p].vertex[k]).z != 1) return false;
            return true;
        };
        for (uint32_t p = 0; p < c.polygon_count; ++p) fronts += isFront(uint8_t(p));
        for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e) {
            const OccluderEdge& edge = o.edges[e];
            if (edge.left >= c.polygon_count || !isFront(edge.left)) continue;
            ASSERT_NE(edge.right, OccluderEdge::kNone);
            const float y = 0.5f * (positionOf(o, c, edge.from).y + positionOf(o, c, edge.to).y);
            const float x = 0.5f * (positionOf(o, c, edge.from).x + positionOf(o, c, edge.to).x);
            if (x > 1 && x < 12 && y > 0 && y < 6) { EXPECT_TRUE(isFront(edge.right)); }
        }
    }
    EXPECT_EQ(fronts, 36u);
}

}  // namespace
}  // namespace sightline
