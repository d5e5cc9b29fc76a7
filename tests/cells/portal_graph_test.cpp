// Where bodies stand among cells: beside points of the bodies, each looked up by itself.
// SPDX-License-Identifier: MIT
#include "sightline/cells/portal_graph.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/bsp/cell_space_fixture.h"
#include "tests/cells/portal_rays.h"

namespace sightline::test {
namespace {

/// As cellAt() of sight lines, but what is beside a tree's bounds is too close to tell.
uint32_t cellWithin(const CellSpace& space, const glm::dvec3& point, double margin, bool& solid) {
    solid = false;
    for (int axis = 0; space.ofTree() && axis < 3; ++axis)
        if (!(point[axis] > space.tree.bounds.min[axis] + margin && point[axis] < space.tree.bounds.max[axis] - margin))
            return CellGraph::kNoCell;
    return cellAt(space, point, margin, solid);
}

bool has(const Array<uint32_t>& cells, uint32_t cell) { return std::binary_search(cells.begin(), cells.end(), cell); }

glm::dvec3 mixed(Random& random, std::span<const glm::dvec3> points) {
    glm::dvec3 sum(0.0);
    double weights = 0;
    for (const glm::dvec3& point : points) {
        const double weight = std::pow(random.uniform(), 3.0);
        sum += weight * point;
        weights += weight;
    }
    return sum / weights;
}

struct Tally {
    uint64_t known = 0, refused = 0, points = 0, cells = 0;
};

void checkBodies(const CellSpace& space, uint64_t seed, double size, Tally& tally) {
    const PortalGraph graph(space);
    const double margin = 4 * graph.tolerance();
    Box3d box = space.tree.bounds;
    for (const CellRegion& region : space.regions) box.grow(region.bounds);
    Random random(seed);
    Array<uint32_t> cells;
    for (int i = 0; i < 400; ++i) {
        // A point, a line, a triangle, a pyramid, small or as large as a room; some of them on a lattice.
        const glm::dvec3 at = randomIn(random, box);
        glm::dvec3 points[5];
        const size_t count = 1 + random.below(5);
        const double extent = size * std::pow(10.0, random.uniform(-4, 0));
        for (size_t k = 0; k < count; ++k) {
            points[k] = at + extent * glm::dvec3(random.uniform(), random.uniform(), random.uniform());
            if (i % 4 == 0) points[k] = box.min + size / 4 * glm::round((points[k] - box.min) / (size / 4));
        }
        const double radius = i % 3 == 0 ? extent * 0.1 : 0;
        const bool known = graph.cellsAround({points, count}, radius, cells);
        EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
        EXPECT_TRUE(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
        (known ? tally.known : tally.refused) += 1;
        bool in_solid = false;
        for (int k = 0; k < 200; ++k) {
            bool solid = false;
            const glm::dvec3 point =
                mixed(random, {points, count}) +
                0.99 * radius * random.uniform() *
                    glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
            const uint32_t cell = cellWithin(space, point, margin, solid);
            in_solid |= solid && cell == CellGraph::kNoCell;
            if (cell == CellGraph::kNoCell || !known) continue;
            ASSERT_TRUE(has(cells, cell)) << "seed " << seed << ", body " << i;
            ++tally.points;
        }
        ASSERT_FALSE(known && in_solid) << "seed " << seed << ", body " << i;
        if (known) tally.cells += cells.size();

        Box3d bounds;
        for (size_t k = 0; k < count; ++k) bounds.grow(points[k]);
        const bool somewhere = graph.cellsOf(bounds, cells);
        EXPECT_EQ(somewhere, !cells.empty());
        const Box3d& all = space.tree.bounds;
        if (space.ofTree() && !Box3d{all.min - space.tolerance, all.max + space.tolerance}.holds(bounds)) {
            EXPECT_FALSE(somewhere) << "beyond the bounds there are no portals";
            continue;
        }
        for (int k = 0; k < 100; ++k) {
            bool solid = false;
            const uint32_t cell = cellWithin(space, randomIn(random, bounds), margin, solid);
            if (cell == CellGraph::kNoCell) continue;
            ASSERT_TRUE(has(cells, cell)) << "seed " << seed << ", box " << i;
        }
    }
}

TEST(PortalGraph, FindsTheCellsOfBodiesInGrids) {
    Tally tally;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        RoomSettings settings{.rooms = {4, 4, 2}};
        if (seed % 3 == 1) settings.origin = {1e5, -3e4, 7e3};
        if (seed % 3 == 2) settings.size = 1e-3;
        CellSpace space = gridSpace(seed, settings);
        if (seed % 4 == 0) {
            space.outside = space.graph.cells++;
            space.regions.push_back({});
        }
        checkBodies(space, seed, settings.size, tally);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(tally.known, 2 * tally.refused);  // what reaches out of the grid is refused, and only that
    EXPECT_GT(tally.refused, 100u);
    EXPECT_GT(tally.points, 100000u);
    EXPECT_LT(tally.cells, 4 * tally.known);
}

TEST(PortalGraph, FindsTheCellsOfBodiesInTrees) {
    Tally tally;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        const glm::dvec3 center = seed % 3 == 0 ? glm::dvec3(1e4, -3e4, 2e4) : glm::dvec3(0.0);
        checkBodies(treeSpace(randomLeafTree(seed, 9, center, seed % 2 == 0)), seed, 1, tally);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(tally.known, 1000u);
    EXPECT_GT(tally.refused, 1000u);
    EXPECT_GT(tally.points, 100000u);
}

TEST(PortalGraph, TakesWhatTouchesAsIn) {
    const CellSpace space = gridSpace(1, {.rooms = {2, 2, 1}});
    const PortalGraph graph(space);
    Array<uint32_t> cells;
    const auto around = [&](const glm::dvec3& point) {
        EXPECT_TRUE(graph.cellsAround({&point, 1}, 0, cells));
        return std::vector<uint32_t>(cells.begin(), cells.end());
    };
    EXPECT_EQ(around({0.5, 0.5, 0.5}), (std::vector<uint32_t>{0}));
    EXPECT_EQ(around({1, 0.5, 0.5}), (std::vector<uint32_t>{0, 1}));
    EXPECT_EQ(around({1, 1, 1}), (std::vector<uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(around({2, 2, 1}), (std::vector<uint32_t>{3}));
    const glm::dvec3 beyond(2 + 1e-6, 1.5, 0.5), nowhere(NAN, 0, 0);
    EXPECT_FALSE(graph.cellsAround({&beyond, 1}, 0, cells));
    EXPECT_FALSE(graph.cellsAround({&nowhere, 1}, 0, cells));
    EXPECT_FALSE(graph.cellsAround({}, 0, cells));
    EXPECT_TRUE(graph.cellsOf({{0.5, 0.5, 0.5}, {9, 0.6, 0.6}}, cells));
    EXPECT_EQ(std::vector<uint32_t>(cells.begin(), cells.end()), (std::vector<uint32_t>{0, 1}));
    EXPECT_FALSE(graph.cellsOf({{3, 3, 3}, {4, 4, 4}}, cells));
    EXPECT_FALSE(graph.cellsOf({}, cells));
}

// A wall may stand in a cell as far as the tolerance: an eye between the cell's end and the wall would see through its back.
TEST(PortalGraph, DoubtsWhatComesAsCloseToAWallAsTheTolerance) {
    constexpr double kTolerance = 1e-3;
    CellSpace rooms = gridSpace(1, {.rooms = {2, 2, 1}}), closed = rooms, halves;
    closed.outside = closed.graph.cells++;
    closed.regions.push_back({});
    halves.tree.nodes.push_back({{1, 0, 0, 0}, {LeafTreeNode::kLeaf, LeafTreeNode::kLeaf | 1}});
    halves.tree.nodes.push_back({{0, 1, 0, -1}, {LeafTreeNode::kLeaf | 1, LeafTreeNode::kLeaf | 2}});
    halves.tree.nodes[0].child[1] = 1;
    halves.tree.contents = {LeafContents::kSolid, LeafContents::kEmpty, LeafContents::kEmpty};
    halves.tree.bounds = {{-1, -1, -1}, {2, 2, 2}};
    halves.graph.cells = 2;
    halves.graph.cell_of_leaf = {CellGraph::kNoCell, 0, 1};
    for (CellSpace* space : {&rooms, &closed, &halves}) {
        space->tolerance = kTolerance;
        const PortalGraph graph(*space);
        Random random(3);
        Array<uint32_t> cells;
        for (int i = 0; i < 300; ++i) {
            // A triangle that reaches from one cell into the next, and comes so near to the wall at x = 0.
            const double away = kTolerance * random.uniform(-2, 4), radius = i % 3 == 0 ? 0.01 : 0;
            glm::dvec3 points[3];
            for (glm::dvec3& point : points)
                for (int axis = 0; axis < 3; ++axis) point[axis] = random.uniform(0.2, axis == 1 ? 1.8 : 0.8);
            points[0].x = radius + away;
            if (std::abs(away - kTolerance) < 1e-6) continue;
            const bool known = graph.cellsAround(points, radius, cells);
            if (space == &closed) {
                EXPECT_TRUE(known);
                EXPECT_EQ(has(cells, closed.outside), away < kTolerance) << away;
            } else {
                EXPECT_EQ(known, away > kTolerance) << away;
            }
            if (space != &closed || radius > 0) continue;
            Box3d box;
            for (const glm::dvec3& point : points) box.grow(point);
            EXPECT_TRUE(graph.cellsOf(box, cells));
            EXPECT_EQ(has(cells, closed.outside), away < kTolerance) << away;
        }
    }
}

// What lies between two regions is the outside's, however narrow it is for the world's size.
TEST(PortalGraph, DoubtsGapsWhateverLiesFarOff) {
    constexpr double kGap = 5e-6;
    for (const double far : {0.0, 1e7, 1e9}) {
        CellSpace space;
        addRegion(space, {{0, 0, 0}, {1, 1, 1}});
        addRegion(space, {{1 + kGap, 0, 0}, {2, 1, 1}});
        if (far > 0) addRegion(space, {{far, 0, 0}, {far + 1, 1, 1}});
        space.outside = static_cast<uint32_t>(space.regions.size());
        space.regions.push_back({});
        space.graph.cells = static_cast<uint32_t>(space.regions.size());
        space.tolerance = 2 * kGap;
        const PortalGraph graph(space);
        Array<uint32_t> cells;
        const glm::dvec3 between(1 + 0.5 * kGap, 0.5, 0.5), within(0.5, 0.5, 0.5);
        EXPECT_TRUE(graph.cellsAround({&between, 1}, 0, cells));
        EXPECT_TRUE(has(cells, 0) && has(cells, 1) && has(cells, space.outside)) << far;
        EXPECT_TRUE(graph.cellsOf({{0.9, 0.4, 0.4}, {1.1, 0.6, 0.6}}, cells));
        EXPECT_TRUE(has(cells, space.outside)) << far;
        EXPECT_TRUE(graph.cellsAround({&within, 1}, 0, cells));
        EXPECT_FALSE(has(cells, space.outside)) << far;
    }
}

TEST(PortalGraph, LaysPortalsSideBySide) {
    const CellSpace space = gridSpace(2, {.rooms = {3, 3, 2}});
    const PortalGraph graph(space);
    uint32_t portals = 0;
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& portal : graph.portalsFrom(cell)) {
            const CellPortal& from = space.graph.portals[portal.portal];
            const uint32_t side = from.cells[0] == cell ? 0 : 1;
            EXPECT_EQ(from.cells[side], cell);
            EXPECT_EQ(from.cells[1 - side], portal.to);
            // The normal points into the cell that is left.
            EXPECT_GT(glm::dot(glm::dvec3(portal.plane), space.regions[cell].bounds.center()) + portal.plane.w, 0);
            ASSERT_EQ(portal.count, from.count);
            for (uint32_t i = 0; i < (portal.count + 3) / 4 * 4; ++i) {
                const glm::dvec3 corner(graph.corners().x[portal.first + i], graph.corners().y[portal.first + i],
                                        graph.corners().z[portal.first + i]);
                EXPECT_EQ(corner, space.graph.points[from.first + std::min(i, portal.count - 1)]);
            }
            ++portals;
        }
    EXPECT_EQ(portals, 2 * graph.portals());
}

TEST(PortalGraph, OneWayPortalsLeaveTheirFirstCellAlone) {
    CellSpace space = gridSpace(2, {.rooms = {3, 3, 2}});
    for (size_t i = 0; i < space.graph.portals.size(); i += 2) space.graph.portals[i].one_way = true;
    const PortalGraph graph(space);
    std::vector<int> left(space.graph.portals.size(), 0);
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& portal : graph.portalsFrom(cell)) {
            ++left[portal.portal];
            if (!space.graph.portals[portal.portal].one_way) continue;
            EXPECT_EQ(space.graph.portals[portal.portal].cells[0], cell);
            EXPECT_EQ(space.graph.portals[portal.portal].cells[1], portal.to);
        }
    for (size_t i = 0; i < left.size(); ++i) EXPECT_EQ(left[i], space.graph.portals[i].one_way ? 1 : 2) << i;
}

}  // namespace
}  // namespace sightline::test
