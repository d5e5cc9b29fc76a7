// Lines through graphs of cells: the same chains as segments through the tree that the graph is of.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/graph_rays.h"

#include <utility>

#include <gtest/gtest.h>

#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/truth/tree_rays.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline::test {
using namespace tools;
namespace {

TEST(GraphRays, FollowTheChainsOfTheTree) {
    uint64_t compared = 0, steps_in_all = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 9, glm::dvec3(0.0), false);
        TreePortalCounts counts;
        const CellGraph graph = cellsOfTree(tree, {}, &counts);
        const TreeRays tree_rays(tree);
        const GraphRays graph_rays(graph, counts.tolerance / 32);
        Random random(seed);
        TreeWalk walk;
        std::vector<GraphStep> steps;
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 a = randomIn(random, tree.bounds), b = randomIn(random, tree.bounds);
            tree_rays.follow(a, b, walk);
            if (walk.stretches.empty()) continue;
            bool clear = tree_rays.stands(a, b, walk, 0, walk.stretches.size() - 1);
            for (const TreeStretch& stretch : walk.stretches) clear &= stretch.to - stretch.from > 1e-9;
            if (!clear) continue;
            graph_rays.follow(graph.cell_of_leaf[walk.stretches[0].leaf], a, b - a, steps);
            // The line may go on behind the end of the segment.
            ASSERT_GE(steps.size(), walk.stretches.size()) << "seed " << seed << ", segment " << i;
            for (size_t k = 0; k < walk.stretches.size(); ++k) {
                ASSERT_EQ(steps[k].cell, graph.cell_of_leaf[walk.stretches[k].leaf])
                    << "seed " << seed << ", segment " << i << ", step " << k;
                ASSERT_EQ(steps[k].before, k == 0 ? GraphStep::kStart : static_cast<uint32_t>(k - 1));
                ASSERT_NEAR(steps[k].at, walk.stretches[k].from, 1e-9);
            }
            for (size_t k = walk.stretches.size(); k < steps.size(); ++k)
                ASSERT_GE(steps[k].at, walk.arrived ? 1 : 2) << "seed " << seed << ", segment " << i;
            ++compared;
            steps_in_all += walk.stretches.size();
        }
    }
    EXPECT_GT(compared, 5000u);
    EXPECT_GT(steps_in_all, 2 * compared);
}

TEST(GraphRays, SeeWhatTheTreeSees) {
    const LeafTree tree = randomLeafTree(3, 9, glm::dvec3(0.0), false);
    TreePortalCounts counts;
    const CellGraph graph = cellsOfTree(tree, {}, &counts);
    AimedHoles holes;
    for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
    BitMatrix all(graph.cells, graph.cells), by_tree(graph.cells, graph.cells), by_graph(graph.cells, graph.cells);
    for (size_t i = 0; i < graph.cells; ++i)
        for (size_t j = 0; j < graph.cells; ++j) all.set(i, j);
    const RowCheckSettings settings{.segments = 200000};
    const GraphRays rays(graph, counts.tolerance / 32);
    EXPECT_EQ(checkLeafRows(TreeRays(tree), all, graph.cell_of_leaf, holes, settings, &by_tree).unmapped, 0u);
    checkCellRows(rays, all, settings, &by_graph);
    EXPECT_EQ(checkCellRows(rays, by_graph, {.segments = 200000}).misses, 0u);
    // Either finds nearly all of what the other does.
    uint64_t both = 0;
    for (size_t i = 0; i < graph.cells; ++i)
        for (size_t j = 0; j < graph.cells; ++j) both += by_tree.at(i, j) && by_graph.at(i, j);
    EXPECT_GT(static_cast<double>(both), 0.97 * static_cast<double>(by_tree.count()));
    EXPECT_GT(static_cast<double>(both), 0.97 * static_cast<double>(by_graph.count()));
    EXPECT_GT(both, 500u);

    BitMatrix lacking = by_graph;
    const CellPortal& portal = graph.portals[7];
    lacking.clear(portal.cells[0], portal.cells[1]);
    const RowReport report = checkCellRows(rays, lacking, {.segments = 20000});
    ASSERT_EQ(report.misses, 1u);
    EXPECT_EQ(report.examples[0].row, portal.cells[0]);
    EXPECT_EQ(report.examples[0].column, portal.cells[1]);
}

/// Cells in a row along x, 1 wide, joined by unit squares that are each moved up by `step`.
CellGraph stairs(uint32_t cells, double step) {
    CellGraph graph;
    graph.cells = cells;
    for (uint32_t i = 1; i < cells; ++i) {
        const double x = i, y = step * i;
        const glm::dvec3 outline[4] = {{x, y, 0}, {x, y, 1}, {x, y + 1, 1}, {x, y + 1, 0}};
        graph.addPortal(i - 1, i, outline);
    }
    return graph;
}

TEST(GraphRays, PassInsideOfTheMarginOnly) {
    const CellGraph graph = stairs(3, 0);
    const GraphRays rays(graph, 1e-3);
    std::vector<GraphStep> steps;
    for (const double y : {-0.1, 0.0, 0.5e-3, 1 - 0.5e-3, 1.0, 1.1}) {
        rays.follow(0, {0, y, 0.5}, {1, 0, 0}, steps);
        EXPECT_EQ(steps.size(), 1u) << y;
    }
    for (const double y : {2e-3, 0.5, 1 - 2e-3}) {
        rays.follow(0, {0, y, 0.5}, {1, 0, 0}, steps);
        EXPECT_EQ(steps.size(), 3u) << y;
        rays.follow(2, {3, y, 0.5}, {-1, 0, 0}, steps);
        EXPECT_EQ(steps.size(), 3u) << y;
        rays.follow(1, {1.5, y, 0.5}, {0, 1, 0}, steps);
        EXPECT_EQ(steps.size(), 1u) << y;
    }
    EXPECT_EQ(graph.portals[0].plane.x, -1);  // counter-clockwise as seen from cell 0, the normal into it
}

// Three cells in a row, the first portal being a slit, and two more far off, which see nothing of them.
TEST(GraphRays, FindSlitsWhateverLiesFarOff) {
    constexpr double kShare = 0x1p-34;
    for (const double far : {1e3, 1e6, 1e7})
        for (const double width : {1e-3, 1e-6, 1e-8}) {
            CellGraph graph = stairs(3, 0);
            for (uint32_t k = 0; k < 4; ++k)
                if (graph.points[k].y > 0) graph.points[k].y = width;
            graph.cells = 5;
            const glm::dvec3 outline[4] = {{far, 0, 0}, {far, 0, 1}, {far, 1, 1}, {far, 1, 0}};
            graph.addPortal(3, 4, outline);
            BitMatrix rows(5, 5);
            for (uint32_t i = 0; i < 5; ++i) rows.set(i, i);
            for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(3, 4)})
                rows.set(a, b), rows.set(b, a);
            const RowCheckSettings settings{.segments = 4000};
            const RowReport report = checkCellRows(GraphRays(graph, {kShare * far, kShare}), rows, settings);
            EXPECT_EQ(report.misses, 2u) << "portal at " << far << ", width " << width;
            // A margin by the largest coordinate of the graph closes the slit.
            if (2 * kShare * far > width) {
                EXPECT_EQ(checkCellRows(GraphRays(graph, {kShare * far}), rows, settings).misses, 0u);
            }
        }
}

TEST(GraphRays, TakeTheirShareOfThePortalAtHand) {
    CellGraph graph = stairs(3, 0);
    for (uint32_t k = 4; k < 8; ++k) graph.points[k].y -= 1e6;
    const GraphRays rays(graph, {1e-3, 0x1p-20, 1e-9});
    EXPECT_EQ(rays.marginOf(0), 0x1p-20 + 1e-9);
    EXPECT_EQ(rays.marginOf(1), 1e-3);
    EXPECT_EQ(GraphRays(graph, {1e-3}).marginOf(0), 1e-3);
}

TEST(GraphRays, LeaveUnionsOfCellsThroughEachPortal) {
    // A row of five cells, the second and the fourth being one: a line through all meets it twice.
    const CellGraph graph = stairs(5, 0.1);
    const std::vector<uint32_t> numbers = {0, 1, 2, 1, 3};
    const CellGraph merged = mergeCells(graph, numbers, 4);
    const GraphRays rays(merged, 1e-9);
    std::vector<GraphStep> steps;
    rays.follow(0, {0, 0.45, 0.5}, {1, 0.1, 0}, steps);
    std::vector<bool> reached(4, false);
    for (const GraphStep& step : steps) reached[step.cell] = true;
    EXPECT_EQ(reached, std::vector<bool>(4, true));
    // Only forward: 0, the union, from it 2 and 3, from 2 the union again, and from that 3 alone.
    EXPECT_EQ(steps.size(), 6u);
    for (const GraphStep& step : steps)
        EXPECT_TRUE(step.before == GraphStep::kStart || step.at > steps[step.before].at);
    BitMatrix none(4, 4), seen(4, 4);
    const RowReport report = checkCellRows(rays, none, {.segments = 2000}, &seen);
    EXPECT_EQ(seen.count(), 16u);
    EXPECT_EQ(report.misses, 16u);
}

}  // namespace
}  // namespace sightline::test
