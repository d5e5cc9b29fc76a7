// The cells of a BSP tree's leaves: they fill space without overlap, and points lie where they are said to.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/bsp_cells.h"

#include <cstdio>

#include "tests/bsp/bsp_fixture.h"

namespace sightline::test {
namespace {

const Box3d kBox{{-2, -2, -2}, {2, 2, 2}};

TEST(BspCells, FillTheBox) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const BspTree tree = buildBsp(randomTriangles(seed, 60, 0.8));
        double sum = 0;
        size_t empty = 0;
        for (uint32_t leaf = 0; leaf < tree.leaf.size(); ++leaf) {
            const double volume = volumeOf(wallsOfLeaf(tree, leaf, kBox));
            ASSERT_GE(volume, -1e-12) << "seed " << seed << ", leaf " << leaf;
            sum += volume;
            empty += volume == 0;
        }
        EXPECT_NEAR(sum, 64, 64e-9) << "seed " << seed;
        EXPECT_LT(empty, tree.leaf.size());
    }
}

TEST(BspCells, HoldTheirMiddles) {
    const BspTree tree = buildBsp(randomTriangles(5, 80, 0.6));
    for (uint32_t leaf = 0; leaf < tree.leaf.size(); ++leaf) {
        const std::vector<BspWall> walls = wallsOfLeaf(tree, leaf, kBox);
        if (volumeOf(walls) < 1e-9) continue;
        glm::dvec3 sum(0.0);
        double corners = 0;
        for (const BspWall& wall : walls)
            for (const glm::dvec3& p : wall.outline) {
                sum += p;
                ++corners;
            }
        EXPECT_EQ(leafOf(tree, sum / corners), leaf);
    }
}

TEST(BspCells, BoundThePointsInThem) {
    const BspTree tree = buildBsp(randomTriangles(6, 200, 0.4));
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = randomVector(random, 2);
        for (const BspBound& bound : boundsOfLeaf(tree, leafOf(tree, p))) {
            const double d = distanceTo(tree.nodes[bound.node].plane, p);
            ASSERT_TRUE(bound.side == kBspFront ? d >= 0 : d < 0) << "point " << i;
        }
    }
}

TEST(BspCells, AreNumberedOnThroughInsertions) {
    BspTree tree = buildBsp(randomTriangles(7, 40, 0.5));
    insertPolygons(tree, randomTriangles(8, 20, 0.5, 100));
    double sum = 0;
    for (uint32_t leaf = 0; leaf < tree.leaf.size(); ++leaf) sum += volumeOf(wallsOfLeaf(tree, leaf, kBox));
    EXPECT_NEAR(sum, 64, 64e-9);
}

TEST(BspCells, OfAnEmptyTreeAreTheBox) {
    const BspTree tree = buildBsp({});
    EXPECT_EQ(leafOf(tree, {1, 2, 3}), 0u);
    EXPECT_TRUE(boundsOfLeaf(tree, 0).empty());
    EXPECT_EQ(wallsOfLeaf(tree, 0, kBox).size(), 6u);
    EXPECT_NEAR(volumeOf(wallsOfLeaf(tree, 0, kBox)), 64, 1e-9);
}

}  // namespace
}  // namespace sightline::test
