// Segments through trees of planes: where they pass, what stops them, and what they say of rows.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/tree_rays.h"

#include <gtest/gtest.h>

#include "sightline/base/thread_pool.h"
#include "sightline/bsp/tree_portals.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline::test {
using namespace tools;
namespace {

AimedHoles holesOf(const CellGraph& graph) {
    AimedHoles holes;
    for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
    return holes;
}

TEST(TreeRays, PassWhatPointsOfTheSegmentLieIn) {
    uint64_t stretches = 0, stopped = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 8);
        const TreeRaySettings settings{.sky_is_open = seed % 2 == 0, .contents_stop = seed % 3 == 0};
        const TreeRays rays(tree, settings);
        Random random(seed);
        TreeWalk walk;
        for (int i = 0; i < 500; ++i) {
            const glm::dvec3 a = randomIn(random, tree.bounds), b = randomIn(random, tree.bounds);
            rays.follow(a, b, walk);
            // Sampled: the first point that lies in what stops a segment tells how far it comes.
            const LeafContents first = tree.contents[rays.leafAt(a)];
            double stop = 2;
            for (int k = 0; k <= 400 && stop > 1; ++k) {
                const uint32_t leaf = rays.leafAt(a + k / 400.0 * (b - a));
                const LeafContents contents = tree.contents[leaf];
                if (contents == LeafContents::kSolid || (contents == LeafContents::kSky && !settings.sky_is_open) ||
                    (contents != first && settings.contents_stop))
                    stop = k / 400.0;
            }
            double end = 0;
            for (const TreeStretch& stretch : walk.stretches) {
                ASSERT_EQ(stretch.from, end);
                end = stretch.to;
                const double middle = 0.5 * (stretch.from + stretch.to);
                ++stretches;
                if (stretch.to - stretch.from < 1e-9) continue;
                ASSERT_EQ(rays.leafAt(a + middle * (b - a)), stretch.leaf) << "seed " << seed << ", segment " << i;
            }
            ASSERT_EQ(walk.arrived, end == 1);
            ASSERT_LE(end, std::min(stop, 1.0) + 1e-12) << "seed " << seed << ", segment " << i;
            stopped += !walk.arrived;
        }
    }
    EXPECT_GT(stretches, 5000u);
    EXPECT_GT(stopped, 1000u);
}

TEST(TreeRays, FindWhatRowsLack) {
    const LeafTree tree = randomLeafTree(3, 9);
    const TreeRays rays(tree);
    const AimedHoles holes = holesOf(cellsOfTree(tree));
    const size_t leaves = tree.contents.size();
    BitMatrix all(leaves, leaves), seen(leaves, leaves);
    for (size_t i = 0; i < leaves; ++i)
        for (size_t j = 0; j < leaves; ++j) all.set(i, j);
    const RowCheckSettings settings{.seed = 5, .segments = 20000};
    RowReport report = checkLeafRows(rays, all, {}, holes, settings, &seen);
    EXPECT_EQ(report.misses, 0u);
    EXPECT_GT(report.segments, 15000u);
    EXPECT_GT(report.stretches, report.segments);
    for (size_t i = 0; i < leaves; ++i)
        for (size_t j = 0; j < leaves; ++j) EXPECT_EQ(seen.at(i, j), seen.at(j, i));

    // What was seen has no miss; each bit that is taken away is one, and its segment shows it.
    report = checkLeafRows(rays, seen, {}, holes, settings);
    EXPECT_EQ(report.misses, 0u);
    Random random(1);
    int tried = 0;
    while (tried < 20) {
        const size_t i = random.below(leaves), j = random.below(leaves);
        if (!seen.at(i, j)) continue;
        BitMatrix lacking = seen;
        lacking.clear(i, j);
        report = checkLeafRows(rays, lacking, {}, holes, settings);
        if (report.misses == 0 && report.doubtful > 0) continue;  // it was seen, but only within rounding
        ASSERT_EQ(report.misses, 1u) << i << " " << j;
        ASSERT_EQ(report.examples.size(), 1u);
        const RowMiss& miss = report.examples[0];
        EXPECT_EQ(miss.row, i);
        EXPECT_EQ(miss.column, j);
        TreeWalk walk;
        rays.follow(miss.from, miss.to, walk);
        size_t at_i = leaves, at_j = leaves;
        for (size_t k = 0; k < walk.stretches.size(); ++k) {
            if (walk.stretches[k].leaf == i) at_i = k;
            if (walk.stretches[k].leaf == j) at_j = k;
        }
        EXPECT_LT(at_i, leaves);
        EXPECT_LT(at_j, leaves);
        ++tried;
    }
}

TEST(TreeRays, SayTheSameOnAnyNumberOfThreads) {
    const LeafTree tree = randomLeafTree(8, 9);
    const TreeRays rays(tree);
    const AimedHoles holes = holesOf(cellsOfTree(tree));
    const size_t leaves = tree.contents.size();
    const BitMatrix none(leaves, leaves);
    BitMatrix seen_one(leaves, leaves), seen_four(leaves, leaves);
    ThreadPool pool(4);
    RowCheckSettings settings{.segments = 5000, .most_examples = 1u << 20};
    const RowReport one = checkLeafRows(rays, none, {}, holes, settings, &seen_one);
    settings.jobs = &pool;
    const RowReport four = checkLeafRows(rays, none, {}, holes, settings, &seen_four);
    EXPECT_EQ(seen_one, seen_four);
    EXPECT_EQ(one.misses, seen_one.count());
    EXPECT_EQ(one.misses, four.misses);
    ASSERT_EQ(one.examples.size(), four.examples.size());
    for (size_t i = 0; i < one.examples.size(); ++i) {
        EXPECT_EQ(one.examples[i].row, four.examples[i].row);
        EXPECT_EQ(one.examples[i].from, four.examples[i].from);
    }
}

/// Two rooms with a wall between them from x = -1 to 1, a slit in it at y from 0 to `width`.
LeafTree slit(double width) {
    LeafTree tree;
    tree.bounds = {glm::dvec3(-10.0), glm::dvec3(10.0)};
    tree.contents = {LeafContents::kEmpty, LeafContents::kEmpty, LeafContents::kSolid, LeafContents::kEmpty,
                     LeafContents::kSolid};
    tree.nodes.resize(4);
    const auto leaf = [](uint32_t i) { return LeafTreeNode::kLeaf | i; };
    tree.nodes[0] = {{1, 0, 0, 1}, {leaf(0), 1}};
    tree.nodes[1] = {{1, 0, 0, -1}, {2, leaf(1)}};
    tree.nodes[2] = {{0, 1, 0, 0}, {leaf(2), 3}};
    tree.nodes[3] = {{0, 1, 0, -width}, {leaf(3), leaf(4)}};
    return tree;
}

TEST(TreeRays, AimedOnesFindSlitsThatOthersDoNot) {
    BitMatrix rows(5, 5);
    for (uint32_t i = 0; i < 5; ++i) rows.set(i, i);
    for (const uint32_t room : {0u, 1u}) rows.set(room, 3), rows.set(3, room);
    for (const double width : {1e-3, 1e-6, 1e-9}) {
        const LeafTree tree = slit(width);
        const TreeRays rays(tree);
        const AimedHoles holes = holesOf(cellsOfTree(tree));
        RowCheckSettings settings{.segments = 4000, .aimed = 0};
        EXPECT_EQ(checkLeafRows(rays, rows, {}, holes, settings).misses, 0u);
        settings.aimed = 1;
        const RowReport report = checkLeafRows(rays, rows, {}, holes, settings);
        EXPECT_EQ(report.misses, 2u) << "width " << width;  // room to room, both ways
    }
    // Within rounding nothing is claimed.
    const LeafTree tree = slit(1e-14);
    const RowReport report =
        checkLeafRows(TreeRays(tree), rows, {}, holesOf(cellsOfTree(tree)), {.segments = 4000, .aimed = 1});
    EXPECT_EQ(report.misses, 0u);
}

// The bounds of a map reach as far as one stray thing does: rounding is that of the segment all the same.
TEST(TreeRays, AimedOnesFindSlitsHoweverFarTheBoundsReach) {
    BitMatrix rows(5, 5);
    for (uint32_t i = 0; i < 5; ++i) rows.set(i, i);
    for (const uint32_t room : {0u, 1u}) rows.set(room, 3), rows.set(3, room);
    for (const double far : {1e3, 1e6, 1e7})
        for (int axis = 0; axis < 3; ++axis)
            for (const double width : {1e-3, 1e-6, 1e-9}) {
                LeafTree tree = slit(width);
                const AimedHoles holes = holesOf(cellsOfTree(tree));
                tree.bounds.max[axis] = far;
                const RowCheckSettings settings{.segments = 4000, .aimed = 1};
                const RowReport report = checkLeafRows(TreeRays(tree), rows, {}, holes, settings);
                EXPECT_EQ(report.misses, 2u) << "bounds " << far << " along " << axis << ", width " << width;
            }
    LeafTree tree = slit(1e-14);
    const AimedHoles holes = holesOf(cellsOfTree(tree));
    tree.bounds.max.x = 1e6;
    EXPECT_EQ(checkLeafRows(TreeRays(tree), rows, {}, holes, {.segments = 4000, .aimed = 1}).misses, 0u);
}

TEST(TreeRays, CountPlacesWithoutARow) {
    const LeafTree tree = slit(1);
    BitMatrix rows(1, 1);
    rows.set(0, 0);
    const std::vector<uint32_t> row_of_leaf = {0, 0, 0, RowJudge::kNoRow, 0};
    const RowReport report =
        checkLeafRows(TreeRays(tree), rows, row_of_leaf, holesOf(cellsOfTree(tree)), {.segments = 1000});
    EXPECT_EQ(report.misses, 0u);
    EXPECT_GT(report.unmapped, 100u);
}

}  // namespace
}  // namespace sightline::test
