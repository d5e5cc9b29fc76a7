// Portals of trees: what crosses from leaf to leaf crosses a portal; what only touches has none; nothing reaches too far.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/tree_portals.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "sightline/bsp/merge_cells.h"
#include "sightline/math/half_spaces.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline::test {
namespace {

/// The portals between two cells, whichever is first.
using PortalsOf = std::multimap<std::pair<uint32_t, uint32_t>, uint32_t>;

PortalsOf portalsOf(const CellGraph& graph) {
    PortalsOf portals;
    for (uint32_t i = 0; i < graph.portals.size(); ++i)
        portals.insert({std::minmax(graph.portals[i].cells[0], graph.portals[i].cells[1]), i});
    return portals;
}

/// Whether a point of the plane lies in the outline, edges included.
bool holds(const CellGraph& graph, const CellPortal& portal, const glm::dvec3& point) {
    const auto outline = graph.outline(portal);
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        if (glm::dot(glm::cross(glm::dvec3(portal.plane), edge), point - outline[i]) < 0) return false;
    }
    return std::abs(glm::dot(portal.plane, glm::dvec4(point, 1))) < 1e-9;
}

struct Crossings {
    uint64_t tried = 0, missing = 0, outside = 0;
};

using Bounds = std::vector<std::vector<glm::dvec4>>;

/// Whether rounding cannot have hidden a leaf between: but for the plane that is crossed, none is near.
bool isClear(const Bounds& bounds, uint32_t a, uint32_t b, const glm::dvec3& point) {
    int near = 0;
    for (const uint32_t leaf : {a, b})
        for (const glm::dvec4& inside : bounds[leaf]) near += std::abs(glm::dot(inside, glm::dvec4(point, 1))) < 4e-11;
    return near == 2;
}

/// Of a segment: each step from a cell to another must be through a portal of both that holds the point.
void followSegment(const LeafTree& tree, const CellGraph& graph, const PortalsOf& portals, const Bounds& bounds,
                   const glm::dvec3& a, const glm::dvec3& b, Crossings& crossings) {
    const std::vector<Stretch> stretches = stretchesOf(tree, a, b);
    const double least = 1e-9;  // a shorter stretch may be rounding
    for (size_t i = 1; i < stretches.size(); ++i) {
        const Stretch &from = stretches[i - 1], &to = stretches[i];
        if (from.to - from.from < least || to.to - to.from < least) continue;
        const uint32_t from_cell = graph.cell_of_leaf[from.leaf], to_cell = graph.cell_of_leaf[to.leaf];
        if (from_cell == CellGraph::kNoCell || to_cell == CellGraph::kNoCell || from_cell == to_cell) continue;
        if (!isClear(bounds, from.leaf, to.leaf, a + to.from * (b - a))) continue;
        ++crossings.tried;
        const auto [first, last] = portals.equal_range(std::minmax(from_cell, to_cell));
        bool held = false;
        for (auto it = first; it != last; ++it) held |= holds(graph, graph.portals[it->second], a + to.from * (b - a));
        crossings.missing += first == last;
        crossings.outside += !held;
    }
}

/// Segments anywhere, and segments through places near the corners of portals, where the thin ones are.
Crossings followSegments(const LeafTree& tree, const CellGraph& graph, uint64_t seed, uint64_t count) {
    const PortalsOf portals = portalsOf(graph);
    const Bounds bounds = boundsOfLeaves(tree);
    Random random(seed);
    Crossings crossings;
    for (uint64_t i = 0; i < count; ++i) {
        glm::dvec3 a = randomIn(random, tree.bounds), b = randomIn(random, tree.bounds);
        if (i % 2 == 1 && !graph.points.empty()) {
            const double size = std::pow(10.0, random.uniform(-7, -1));
            const glm::dvec3 corner = graph.points[random.below(graph.points.size())] +
                                      size * randomIn(random, {glm::dvec3(-1.0), glm::dvec3(1.0)});
            a = glm::clamp(a, corner - 1.0, corner + 1.0);
            b = corner + 0.9 * (corner - a);
            a = glm::clamp(a, tree.bounds.min, tree.bounds.max);
            b = glm::clamp(b, tree.bounds.min, tree.bounds.max);
        }
        followSegment(tree, graph, portals, bounds, a, b, crossings);
    }
    return crossings;
}

TEST(TreePortals, HoldEveryCrossing) {
    uint64_t tried = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const glm::dvec3 center = seed % 4 == 0 ? glm::dvec3(10000, -3000, 777) : glm::dvec3(0.0);
        const LeafTree tree = randomLeafTree(seed, 5 + static_cast<int>(seed % 7), center);
        const CellGraph graph = cellsOfTree(tree, {.sky_is_open = seed % 3 == 0});
        const Crossings crossings = followSegments(tree, graph, seed, 10000);
        EXPECT_EQ(crossings.missing, 0u) << "seed " << seed;
        EXPECT_EQ(crossings.outside, 0u) << "seed " << seed << " of " << crossings.tried;
        tried += crossings.tried;
    }
    EXPECT_GT(tried, 100000u);
}

/// The path to a leaf, beginning with a node: which side of which node it lies on.
using Path = std::vector<std::pair<uint32_t, uint32_t>>;

std::vector<Path> pathsOf(const LeafTree& tree) {
    std::vector<Path> paths(tree.contents.size());
    Path path;
    const auto walk = [&](const auto& self, uint32_t child) -> void {
        if ((child & LeafTreeNode::kLeaf) != 0) {
            paths[child & ~LeafTreeNode::kLeaf] = path;
            return;
        }
        for (uint32_t side = 0; side < 2; ++side) {
            path.emplace_back(child, side);
            self(self, tree.nodes[child].child[side]);
            path.pop_back();
        }
    };
    walk(walk, tree.nodes.empty() ? LeafTreeNode::kLeaf : 0);
    return paths;
}

/// By the definition: where two paths part, whether exactly the planes of both leave anything of the node's plane.
bool shareAFace(const LeafTree& tree, const Path& a, const Path& b) {
    size_t common = 0;
    while (a[common] == b[common]) ++common;
    const glm::dvec4& plane = tree.nodes[a[common].first].plane;
    if (glm::dvec3(plane) == glm::dvec3(0.0)) return false;
    std::vector<glm::dvec4> insides;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 inside(0.0);
        inside[axis] = 1;
        inside.w = -tree.bounds.min[axis];
        insides.push_back(inside);
        inside = -inside;
        inside.w = tree.bounds.max[axis];
        insides.push_back(inside);
    }
    for (const Path* path : {&a, &b})
        for (size_t i = 0; i < path->size(); ++i) {
            if (i == common) continue;
            const auto [node, side] = (*path)[i];
            const glm::dvec4 inside = side == 1 ? tree.nodes[node].plane : -tree.nodes[node].plane;
            if (glm::dvec3(inside) == glm::dvec3(0.0)) {
                if ((tree.nodes[node].plane.w >= 0) != (side == 1)) return false;
                continue;
            }
            const double facing = glm::dot(glm::dvec3(inside), glm::dvec3(plane)) * ((*path)[common].second ? 1 : -1);
            if (i > common && samePlane(inside, plane) && facing > 0) continue;
            insides.push_back(inside);
        }
    return openInPlane(plane, insides);
}

TEST(TreePortals, AreTheFacesByDefinition) {
    uint64_t faces = 0, slivers = 0;
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 7);
        TreePortalCounts counts;
        const CellGraph graph = cellsOfTree(tree, {}, &counts);
        const PortalsOf portals = portalsOf(graph);
        const std::vector<Path> paths = pathsOf(tree);
        for (uint32_t a = 0; a < paths.size(); ++a)
            for (uint32_t b = 0; b < a; ++b) {
                const uint32_t cell_a = graph.cell_of_leaf[a], cell_b = graph.cell_of_leaf[b];
                if (cell_a == CellGraph::kNoCell || cell_b == CellGraph::kNoCell) continue;
                const bool face = shareAFace(tree, paths[a], paths[b]);
                ASSERT_EQ(portals.count({cell_b, cell_a}), face ? 1u : 0u)
                    << "seed " << seed << ", leaves " << b << " and " << a;
                faces += face;
            }
        slivers += counts.slivers;
    }
    EXPECT_GT(faces, 500u);
    EXPECT_GT(slivers, 50u);
}

TEST(TreePortals, ReachNoFartherThanTheTolerance) {
    uint64_t slivers = 0, touching = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const LeafTree tree = randomLeafTree(seed, 7);
        TreePortalCounts counts;
        const CellGraph graph = cellsOfTree(tree, {}, &counts);
        EXPECT_LT(counts.tolerance, 1e-6);
        EXPECT_EQ(counts.doubtful, 0u);
        slivers += counts.slivers;
        touching += counts.touching;
        const Bounds bounds = boundsOfLeaves(tree);
        std::vector<uint32_t> leaf_of_cell(graph.cells);
        for (uint32_t leaf = 0; leaf < bounds.size(); ++leaf)
            if (graph.cell_of_leaf[leaf] != CellGraph::kNoCell) leaf_of_cell[graph.cell_of_leaf[leaf]] = leaf;
        for (const CellPortal& portal : graph.portals) {
            ASSERT_GE(portal.count, 3u);
            ASSERT_LT(portal.thickness, 1e-12 * 64);
            ASSERT_NEAR(glm::length(glm::dvec3(portal.plane)), 1, 1e-12);
            for (uint32_t side = 0; side < 2; ++side)
                for (const glm::dvec4& inside : bounds[leaf_of_cell[portal.cells[side]]])
                    for (const glm::dvec3& point : graph.outline(portal))
                        ASSERT_GE(glm::dot(inside, glm::dvec4(point, 1)),
                                  -counts.tolerance * std::max(1.0, glm::length(glm::dvec3(inside))))
                            << "seed " << seed;
            // Counter-clockwise as seen from the first cell, and wider than nothing.
            const auto outline = graph.outline(portal);
            glm::dvec3 area(0.0);
            for (size_t i = 1; i + 1 < outline.size(); ++i)
                area += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
            ASSERT_GT(glm::dot(area, glm::dvec3(portal.plane)), 0);
        }
        const CellFaults faults = checkCells(graph, 2 * counts.tolerance);
        EXPECT_EQ(faults.concave_portals, 0u);
        EXPECT_EQ(faults.concave_cells, 0u);
    }
    EXPECT_GT(slivers, 10u);
    EXPECT_GT(touching, 100u);
}

/// A tree of planes one after the other, all of space on the far side of each being a leaf.
LeafTree octants() {
    LeafTree tree;
    tree.bounds = {glm::dvec3(-1.0), glm::dvec3(1.0)};
    tree.contents.assign(8, LeafContents::kEmpty);
    tree.nodes.resize(7);
    for (uint32_t i = 0; i < 7; ++i) {
        const int axis = i == 0 ? 0 : i < 3 ? 1 : 2;
        tree.nodes[i].plane[axis] = 1;
        for (uint32_t side = 0; side < 2; ++side)
            tree.nodes[i].child[side] = i < 3 ? 2 * i + 1 + side : LeafTreeNode::kLeaf | (2 * (i - 3) + side);
    }
    return tree;
}

TEST(TreePortals, AreNotWhereCellsOnlyTouch) {
    TreePortalCounts counts;
    CellGraph graph = cellsOfTree(octants(), {}, &counts);
    EXPECT_EQ(graph.cells, 8u);
    EXPECT_EQ(graph.portals.size(), 12u);  // the faces of eight cubes, not their edges and corners
    for (const CellPortal& portal : graph.portals) EXPECT_EQ(portal.count, 4u);
    EXPECT_EQ(counts.slivers, 0u);

    // The least step apart, there is a slit.
    LeafTree moved = octants();
    moved.nodes[1].plane.w = 0x1p-60;
    graph = cellsOfTree(moved, {}, &counts);
    EXPECT_EQ(graph.portals.size(), 14u);
    EXPECT_EQ(counts.slivers, 2u);
}

TEST(TreePortals, KeepCellsOfTheSamePlaneApart) {
    // A plane, and the same again in front of it: behind the second there is nothing.
    LeafTree tree;
    tree.bounds = {glm::dvec3(-1.0), glm::dvec3(1.0)};
    tree.contents.assign(3, LeafContents::kEmpty);
    tree.nodes.resize(2);
    tree.nodes[0].plane = {1, 0, 0, 0};
    tree.nodes[0].child[0] = LeafTreeNode::kLeaf | 0;
    tree.nodes[0].child[1] = 1;
    tree.nodes[1].plane = {-2, 0, 0, 0};
    tree.nodes[1].child[0] = LeafTreeNode::kLeaf | 1;
    tree.nodes[1].child[1] = LeafTreeNode::kLeaf | 2;
    const CellGraph graph = cellsOfTree(tree);
    ASSERT_EQ(graph.portals.size(), 1u);
    EXPECT_EQ(graph.portals[0].cells[0], 1u);
    EXPECT_EQ(graph.portals[0].cells[1], 0u);
}

TEST(TreePortals, HeedContents) {
    LeafTree tree = octants();
    tree.contents[0] = LeafContents::kLiquid;
    tree.contents[3] = LeafContents::kSky;
    tree.contents[7] = LeafContents::kSolid;
    CellGraph graph = cellsOfTree(tree);
    EXPECT_EQ(graph.cells, 6u);
    EXPECT_EQ(graph.portals.size(), 7u);  // three fewer for the sky and for the solid, but they share one
    EXPECT_EQ(graph.cell_of_leaf[3], CellGraph::kNoCell);
    EXPECT_EQ(graph.cell_of_leaf[7], CellGraph::kNoCell);
    EXPECT_EQ(cellsOfTree(tree, {.sky_is_open = true}).portals.size(), 9u);
    EXPECT_EQ(cellsOfTree(tree, {.contents_stop = true}).portals.size(), 4u);
    EXPECT_EQ(cellsOfTree(tree, {.sky_is_open = true, .contents_stop = true}).portals.size(), 4u);

    tree.contents.push_back(LeafContents::kEmpty);  // of another tree
    graph = cellsOfTree(tree);
    EXPECT_EQ(graph.cells, 6u);
    EXPECT_EQ(graph.cell_of_leaf[8], CellGraph::kNoCell);

    LeafTree one;
    one.contents = {LeafContents::kEmpty};
    graph = cellsOfTree(one);
    EXPECT_EQ(graph.cells, 1u);
    EXPECT_TRUE(graph.portals.empty());
}

TEST(TreePortals, AreTheSameForATreeThatIsAList) {
    // A thousand slabs, one behind the other: deeper than any stack of calls would like, and exact.
    LeafTree tree;
    tree.bounds = {glm::dvec3(0.0), glm::dvec3(1000, 1, 1)};
    constexpr uint32_t kSlabs = 1000;
    tree.contents.assign(kSlabs + 1, LeafContents::kEmpty);
    tree.nodes.resize(kSlabs);
    for (uint32_t i = 0; i < kSlabs; ++i) {
        tree.nodes[i].plane = {1, 0, 0, -(i + 0.5)};
        tree.nodes[i].child[0] = LeafTreeNode::kLeaf | i;
        tree.nodes[i].child[1] = i + 1 < kSlabs ? i + 1 : LeafTreeNode::kLeaf | kSlabs;
    }
    const CellGraph graph = cellsOfTree(tree);
    EXPECT_EQ(graph.portals.size(), kSlabs);
    EXPECT_EQ(groupsOf(graph), std::vector<uint32_t>(kSlabs + 1, 0));
}

TEST(MergeCells, KeepsWhatLeadsOut) {
    const CellGraph graph = cellsOfTree(octants());
    // The four columns along x, one of them walled up.
    const std::vector<uint32_t> columns = {0, 1, 2, CellGraph::kNoCell, 0, 1, 2, CellGraph::kNoCell};
    const CellGraph merged = mergeCells(graph, columns, 3);
    EXPECT_EQ(merged.cells, 3u);
    EXPECT_EQ(merged.portals.size(), 4u);
    EXPECT_EQ(merged.cell_of_leaf, columns);
    EXPECT_EQ(cellsFromLeaves(graph, columns), columns);
    EXPECT_EQ(groupsOf(merged), (std::vector<uint32_t>{0, 0, 0}));
    const std::vector<uint32_t> ends = {0, CellGraph::kNoCell, CellGraph::kNoCell, 1,
                                        0, CellGraph::kNoCell, CellGraph::kNoCell, 1};
    EXPECT_EQ(groupsOf(mergeCells(graph, ends, 2)), (std::vector<uint32_t>{0, 1}));
}

TEST(MergeCells, GroupsAreThoseOfAFlood) {
    const LeafTree tree = randomLeafTree(3, 9);
    const CellGraph graph = cellsOfTree(tree, {.contents_stop = true});
    std::vector<uint32_t> expected(graph.cells, ~0u);
    uint32_t groups = 0;
    for (uint32_t first = 0; first < graph.cells; ++first) {
        if (expected[first] != ~0u) continue;
        expected[first] = groups;
        for (bool grew = true; grew;) {
            grew = false;
            for (const CellPortal& portal : graph.portals)
                if ((expected[portal.cells[0]] == groups) != (expected[portal.cells[1]] == groups)) {
                    expected[portal.cells[0]] = expected[portal.cells[1]] = groups;
                    grew = true;
                }
        }
        ++groups;
    }
    EXPECT_EQ(groupsOf(graph), expected);
    EXPECT_GT(groups, 3u);
}

}  // namespace
}  // namespace sightline::test
