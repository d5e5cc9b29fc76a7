// Graphs that no map should have, and that some have: bakes of them hold to the same laws.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/bsp/tree_portals.h"
#include "tests/bake/flow/visibility_laws.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline::test {
using namespace bake;
namespace {

/// A square in the plane x, about +x.
std::vector<glm::dvec3> square(double x, double low, double high) {
    return {{x, low, low}, {x, high, low}, {x, high, high}, {x, low, high}};
}

TEST(OddGraphs, WithoutPortalsSeeThemselvesAlone) {
    for (const uint32_t cells : {0u, 1u, 2u, 64u, 65u}) {
        CellGraph graph;
        graph.cells = cells;
        const CellVisibility answer = bakeCellVisibility(graph);
        expectShape(answer, cells, "no portals");
        EXPECT_EQ(answer.visible.count(), cells);
        EXPECT_EQ(answer.steps, 0u);
    }
}

TEST(OddGraphs, OfTwoCellsSeeOneAnother) {
    CellGraph graph;
    graph.cells = 3;
    graph.addPortal(1, 0, square(0, 0, 1));
    const CellVisibility answer = bakeCellVisibility(graph);
    expectLaws(graph, answer, 1000, "two cells");
    EXPECT_EQ(answer.visible.count(), 5u);
    EXPECT_EQ(answer.witnessed.count(), 5u);
}

TEST(OddGraphs, HaveAnyNumberOfPortalsBetweenTwoCells) {
    // Many small ones side by side, some of them twice, and a row of cells to look along.
    CellGraph graph;
    graph.cells = 6;
    for (uint32_t i = 0; i < 5; ++i)
        for (int k = 0; k < 20; ++k) {
            const double low = 0.05 * k;
            graph.addPortal(i + 1, i, square(i, low, low + 0.04));
            if (k % 3 == 0) graph.addPortal(i + 1, i, square(i, low, low + 0.04));
        }
    const CellVisibility answer = bakeCellVisibility(graph);
    expectLaws(graph, answer, 20000, "many portals");
    EXPECT_EQ(answer.witnessed.count(), 36u);
}

TEST(OddGraphs, HavePortalsWithManyCorners) {
    // More corners than a window has room for.
    for (const uint32_t corners : {30u, 39u, 40u, 41u, 64u, 200u}) {
        const CellGraph graph = bentTube(corners, 12, 0.1, corners);
        const CellVisibility answer = bakeCellVisibility(graph);
        expectLaws(graph, answer, 20000, nameOf("corners", corners));
    }
}

TEST(OddGraphs, HavePortalsWithoutAnArea) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        CellGraph graph = gridOfRooms(seed, {.rooms = {4, 4, 2}});
        const CellVisibility before = bakeCellVisibility(graph);
        const size_t doors = graph.portals.size();
        for (int i = 0; i < 10; ++i) {
            const CellPortal portal = graph.portals[random.below(doors)];
            const glm::dvec3 a = graph.points[portal.first],
                             b = graph.points[portal.first + 1 + random.below(portal.count - 1)];
            const std::vector<glm::dvec3> line = {a, b, 0.5 * (a + b), a};
            graph.addPortal(portal.cells[0], portal.cells[1], line, portal.plane);
        }
        const CellVisibility answer = bakeCellVisibility(graph);
        expectLaws(graph, answer, 20000, nameOf("seed", seed));
        EXPECT_TRUE(isWithin(before.witnessed, answer.visible)) << "seed " << seed;
    }
}

TEST(OddGraphs, AreFarAwayOrTinyOrHuge) {
    for (uint64_t seed = 1; seed <= 4; ++seed)
        for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6})
            for (const double away : {0.0, 1.0, 1e3}) {
                const CellGraph graph = gridOfRooms(
                    seed, {.rooms = {4, 3, 2}, .origin = glm::dvec3(away, -away, 2 * away) * size, .size = size});
                const CellVisibility answer = bakeCellVisibility(graph);
                expectLaws(graph, answer, 20000, "size " + std::to_string(size) + ", away " + std::to_string(away));
                EXPECT_GT(5 * answer.witnessed.count(), 4 * answer.visible.count());
            }
}

/// Rooms in a row, whose doors lie to the right and to the left of a line in turn, each `gap` away from it.
CellGraph zigzag(uint32_t cells, double gap, const glm::dmat3& turn) {
    CellGraph graph;
    graph.cells = cells;
    for (uint32_t i = 1; i < cells; ++i) {
        const double x = i, low = i % 2 ? 0.5 + gap : 0.1, high = i % 2 ? 0.9 : 0.5 - gap;
        std::vector<glm::dvec3> outline = {{x, low, 0}, {x, high, 0}, {x, high, 1}, {x, low, 1}};
        for (glm::dvec3& point : outline) point = turn * point;
        graph.addPortal(i, i - 1, outline);
    }
    return graph;
}

TEST(OddGraphs, SeeAlongLinesThatGraze) {
    for (uint64_t seed = 0; seed <= 50; ++seed) {
        Random random(seed);
        const double a = seed ? random.uniform(0, 7) : 0, b = seed ? random.uniform(0, 7) : 0;
        const glm::dmat3 about_z(std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1),
            about_x(1, 0, 0, 0, std::cos(b), std::sin(b), 0, -std::sin(b), std::cos(b));
        const glm::dmat3 turn = about_z * about_x * (seed % 2 ? 1.0 : 1e3);
        const CellVisibility grazing = bakeCellVisibility(zigzag(7, 0, turn));
        EXPECT_EQ(grazing.visible.count(), 49u) << "seed " << seed;
        EXPECT_LT(grazing.witnessed.count(), 49u) << "seed " << seed;
        const CellVisibility apart = bakeCellVisibility(zigzag(7, 1e-6, turn));
        EXPECT_LT(apart.visible.count(), 49u) << "seed " << seed;
        const CellVisibility open = bakeCellVisibility(zigzag(7, -1e-3, turn));
        EXPECT_EQ(open.witnessed.count(), 49u) << "seed " << seed;
    }
}

TEST(OddGraphs, SeeThroughCellsOfAnyThickness) {
    for (const double gap : {1.0, 1e-3, 1e-6, 1e-7, 1e-8, 1e-10, 0.0}) {
        CellGraph graph;
        graph.cells = 4;
        for (const double x : {0.0, gap, gap + 10}) {
            const std::vector<glm::dvec3> outline = {{x, 0, 0}, {x, 1, 0}, {x, 1, 1}, {x, 0, 1}};
            const uint32_t cell = static_cast<uint32_t>(graph.portals.size());
            ASSERT_TRUE(graph.addPortal(cell + 1, cell, outline));
        }
        EXPECT_EQ(bakeCellVisibility(graph).visible.count(), 16u) << gap;
    }
}

/// A rectangle in the plane x, about +x, from z = 0 to 1.
std::vector<glm::dvec3> upright(double x, double low, double high) {
    return {{x, low, 0}, {x, high, 0}, {x, high, 1}, {x, low, 1}};
}

/// Adds a portal between two cells of their own, so far off.
void addFarPortal(CellGraph& graph, double far) {
    graph.cells += 2;
    if (far > 0) graph.addPortal(graph.cells - 1, graph.cells - 2, upright(far, 0, 1));
}

TEST(OddGraphs, SeeThroughThinCellsWhateverLiesFarOff) {
    for (const double far : {0.0, 1e5, 1e7, 1e9}) {
        // A cavity of a millimetre whose openings do not lie over one another.
        CellGraph cavity;
        cavity.cells = 3;
        cavity.addPortal(1, 0, upright(0, 0, 1));
        cavity.addPortal(2, 1, upright(1e-3, 1.5, 2.5));
        addFarPortal(cavity, far);
        EXPECT_TRUE(bakeCellVisibility(cavity).visible.at(0, 2)) << far;
        // A cell without thickness whose openings share half a millimetre.
        CellGraph flat;
        flat.cells = 3;
        flat.addPortal(1, 0, upright(0, 0, 1));
        flat.addPortal(2, 1, upright(0, 1 - 5e-4, 2));
        addFarPortal(flat, far);
        EXPECT_TRUE(bakeCellVisibility(flat).visible.at(0, 2)) << far;
    }
}

// By the precision of the last portal, which reaches far off, all three lie in one plane; by those of the others they do not.
TEST(OddGraphs, SeeThroughStacksOfThinCells) {
    CellGraph stack;
    stack.cells = 4;
    stack.addPortal(1, 0, upright(0, 0, 1));
    stack.addPortal(2, 1, upright(1.3e-4, 0, 1));
    stack.addPortal(3, 2, upright(2.6e-4, 0, 1e7));
    EXPECT_EQ(bakeCellVisibility(stack).visible.count(), 16u);
}

/// A slit between two cells, as wide as told, whose corners lie off its plane by less than points are known to; and a
/// low door far behind it, which lies above the slit's plane, but below that of its corners.
CellGraph slitAndDoor(double width, bool turned, Random& random) {
    constexpr double kOff = 0x1p-36 * 4096;
    CellGraph graph;
    graph.cells = 4;
    const auto off = [&] { return random.uniform(-kOff, kOff); };
    std::vector<glm::dvec3> slit = {{0, off(), 0}, {0, off(), width}, {10, off(), width}, {10, off(), 0}};
    glm::dvec4 plane(0, 1, 0, 0);
    if (turned) std::reverse(slit.begin(), slit.end()), plane = -plane;
    graph.addPortal(!turned, turned, slit, plane);
    const double low = 0.01, high = 0.02;
    const std::vector<glm::dvec3> door = {{0, low, 100}, {10, low, 100}, {10, high, 100}, {0, high, 100}};
    graph.addPortal(1, 2, door, {0, 0, -1, 100});
    // What makes the world large.
    const std::vector<glm::dvec3> away = {{4000, 0, 4090}, {4090, 0, 4090}, {4090, 90, 4090}, {4000, 90, 4090}};
    graph.addPortal(2, 3, away, {0, 0, -1, 4090});
    return graph;
}

TEST(OddGraphs, SeeThroughSlitsBesideWhosePlaneTheirCornersLie) {
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        const double width = std::exp2(random.uniform(-16, -8));
        const CellGraph graph = slitAndDoor(width, seed % 2, random);
        EXPECT_TRUE(bakeCellVisibility(graph).visible.at(0, 2)) << "seed " << seed << ", width " << width;
    }
}

TEST(OddGraphs, ComeFromTreesWhosePlanesRepeat) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const CellGraph graph = cellsOfTree(randomLeafTree(seed, 8));
        expectLaws(graph, bakeCellVisibility(graph), 50000, nameOf("seed", seed));
    }
}

}  // namespace
}  // namespace sightline::test
