// Groups of open leaves, and portals made one.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/open_groups.h"

#include <set>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/tree_portals.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline {
namespace {

using namespace test;

/// A room of 8 x 4 x 4, divided at x = 0 by a wall of the given height, and by nothing at x = -2.
LeafTree dividedRoom(double wall) {
    LeafTree tree;
    tree.bounds = {glm::dvec3(-4, -2, -2), glm::dvec3(4, 2, 2)};
    const auto leaf = [](uint32_t number) { return LeafTreeNode::kLeaf + number; };
    // Behind x = 0 lies x = -2; before it a wall of thickness 0.1, up to its height.
    tree.nodes.push_back({{1, 0, 0, 0}, {1, 2}});
    tree.nodes.push_back({{1, 0, 0, 2}, {leaf(1), leaf(2)}});
    tree.nodes.push_back({{1, 0, 0, -0.1}, {3, leaf(3)}});
    tree.nodes.push_back({{0, 1, 0, 2 - wall}, {leaf(0), leaf(4)}});
    tree.contents = {LeafContents::kSolid, LeafContents::kEmpty, LeafContents::kEmpty, LeafContents::kEmpty,
                     LeafContents::kEmpty};
    return tree;
}

uint32_t groupOfLeaf(const CellGraph& graph, const OpenGroups& groups, uint32_t leaf) {
    return groups.group_of_cell[graph.cell_of_leaf[leaf]];
}

TEST(OpenGroups, JoinOverALowWallAndNotOverAHighOne) {
    for (const double wall : {0.5, 3.5}) {
        const LeafTree tree = dividedRoom(wall);
        const CellGraph graph = cellsOfTree(tree);
        const OpenGroups groups = groupOpenCells(tree, graph, {.largest = 2});
        EXPECT_EQ(groupOfLeaf(graph, groups, 1), groupOfLeaf(graph, groups, 2));
        EXPECT_EQ(groupOfLeaf(graph, groups, 3) == groupOfLeaf(graph, groups, 1), wall < 2) << wall;
    }
}

TEST(OpenGroups, AreNoLargerThanAsked) {
    const LeafTree tree = dividedRoom(0.5);
    const CellGraph graph = cellsOfTree(tree);
    EXPECT_EQ(groupOpenCells(tree, graph, {.largest = 0.01}).groups, graph.cells);
}

TEST(OpenGroups, GiveEachCellOneOfTheGroups) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 8);
        const CellGraph graph = cellsOfTree(tree);
        for (const double openness : {0.0, 0.5, 1.0}) {
            const OpenGroups groups = groupOpenCells(tree, graph, {.openness = openness});
            ASSERT_EQ(groups.group_of_cell.size(), graph.cells);
            const std::set<uint32_t> used(groups.group_of_cell.begin(), groups.group_of_cell.end());
            EXPECT_EQ(used.size(), groups.groups) << seed;
            if (!used.empty()) { EXPECT_EQ(*used.rbegin() + 1, groups.groups) << seed; }
        }
    }
}

/// Whether a point of a plane is inside of an outline, or within a hair of it.
bool isInside(const CellGraph& graph, const CellPortal& portal, const glm::dvec3& point) {
    const std::span<const glm::dvec3> outline = graph.outline(portal);
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        if (glm::dot(glm::cross(edge, point - outline[i]), glm::dvec3(portal.plane)) < -1e-9) return false;
    }
    return true;
}

TEST(JoinPortals, HoldAllThatTheyAreMadeOf) {
    uint64_t before = 0, after = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 8, glm::dvec3(0.0), false);
        const CellGraph cells = cellsOfTree(tree);
        const OpenGroups groups = groupOpenCells(tree, cells, {.openness = 0.1, .largest = 1});
        const CellGraph merged = mergeCells(cells, groups.group_of_cell, groups.groups);
        const CellGraph joined = joinPortals(merged);
        EXPECT_EQ(joined.cells, merged.cells);
        EXPECT_EQ(joined.cell_of_leaf, merged.cell_of_leaf);
        before += merged.portals.size();
        after += joined.portals.size();
        for (const CellPortal& part : merged.portals)
            for (const glm::dvec3& point : merged.outline(part)) {
                bool held = false;
                for (const CellPortal& whole : joined.portals) {
                    const bool same = whole.cells[0] == part.cells[0] && whole.cells[1] == part.cells[1];
                    const bool turned = whole.cells[0] == part.cells[1] && whole.cells[1] == part.cells[0];
                    const glm::dvec4 plane = turned ? -whole.plane : whole.plane;
                    held |= (same || turned) && plane == part.plane && isInside(joined, whole, point);
                }
                EXPECT_TRUE(held) << seed;
            }
    }
    EXPECT_LT(after, before);
}

TEST(JoinPortals, LeaveDoorsAlone) {
    CellGraph graph;
    graph.cells = 2;
    const std::vector<glm::dvec3> low = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
    std::vector<glm::dvec3> high = low;
    for (glm::dvec3& point : high) point.y += 2;
    ASSERT_TRUE(graph.addPortal(0, 1, low));
    ASSERT_TRUE(graph.addPortal(0, 1, high));
    EXPECT_EQ(joinPortals(graph).portals.size(), 1u);
    graph.portals[1].door = 7;
    EXPECT_EQ(joinPortals(graph).portals.size(), 2u);
}

}  // namespace
}  // namespace sightline
