// Windows through portals: no sight line passes a cell that is not in the answer, or outside its window.
// SPDX-License-Identifier: MIT
#include "sightline/cells/portals.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/bsp/cell_space_fixture.h"
#include "tests/cells/portal_rays.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace tools;
namespace {

constexpr PortalWindows kKinds[] = {PortalWindows::kBoxes, PortalWindows::kOctagons, PortalWindows::kPolygons};

/// A point of the world, or one of a place that is unpleasant: in a hole, on a plane, in a corner.
glm::dvec3 hardPoint(Random& random, const CellSpace& space, const Box3d& box) {
    const CellGraph& graph = space.graph;
    const CellPortal& portal = graph.portals[random.below(graph.portals.size())];
    const auto outline = graph.outline(portal);
    switch (random.below(8)) {
        case 0:
            return pointInHole(random, outline);
        case 1:
            return pointInHole(random, outline) + 1e-7 * randomDirection(random);
        case 2: {
            const glm::dvec3 corner = outline[random.below(outline.size())];
            return corner + std::pow(10.0, random.uniform(-9, -1)) * randomDirection(random);
        }
        case 3: {
            // In the plane of a portal, outside of it.
            const glm::dvec3 point = randomIn(random, box), normal(portal.plane);
            return point - (glm::dot(normal, point) + portal.plane.w) * normal;
        }
        default:
            return randomIn(random, box);
    }
}

Box3d boxOf(const CellSpace& space) {
    Box3d box = space.tree.bounds;
    for (const CellRegion& region : space.regions) box.grow(region.bounds);
    return box;
}

std::vector<uint32_t> cellsOf(const PortalFlood& flood) {
    std::vector<uint32_t> cells;
    for (const SeenCell& cell : flood.cells()) cells.push_back(cell.cell);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

constexpr int kRays = 1000;  // of a view

/// Views of a world, each kind of window of each judged by rays.
struct Sweep {
    uint64_t answers = 0, refused = 0, cells[3] = {0, 0, 0};
    RayTally tally;

    void run(const CellSpace& space, uint64_t seed, int views, int rays_each, double margin, double size) {
        const PortalGraph graph(space);
        const GraphRays rays(space.graph, margin);
        PortalJudge judge(space, rays);
        PortalFlood flood;
        Random random(seed);
        const Box3d box = boxOf(space);
        for (int i = 0; i < views; ++i) {
            const KnownView known = randomView(random, hardPoint(random, space, box), size);
            for (int kind = 0; kind < 3; ++kind) {
                if (!flood.run(graph, known.view, {.windows = kKinds[kind]})) {
                    ++refused;
                    continue;
                }
                ++answers;
                cells[kind] += cellsOf(flood).size();
                judge.judge(known, flood, random, rays_each, tally);
                ASSERT_EQ(tally.missed, 0u)
                    << "seed " << seed << ", view " << i << ", " << kWindowNames[kind] << ": " << tally.example;
                ASSERT_EQ(tally.solid, 0u) << "seed " << seed << ", view " << i << ", " << kWindowNames[kind];
            }
        }
    }
};

TEST(Portals, HoldEachSightLineOfGrids) {
    Sweep sweep;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        RoomSettings settings{.rooms = {4, 4, 2}};
        if (seed % 4 == 1) settings.origin = {3e4, -2e4, 5e4};
        if (seed % 4 == 2) settings.size = 1e-3;
        if (seed % 4 == 3) settings.size = 1e5;
        const CellSpace space = gridSpace(seed, settings);
        sweep.run(space, seed, 150, kRays, 1e-8 * settings.size + 1e-12 * largestCoordinate(space.graph),
                  settings.size);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(sweep.answers, 2 * sweep.refused);
    EXPECT_GT(sweep.tally.rays, 1000000u);
    EXPECT_GT(sweep.tally.steps, sweep.tally.rays + 500000);
    EXPECT_LE(sweep.cells[1], sweep.cells[0]);
    EXPECT_LE(sweep.cells[2], sweep.cells[1]);
}

TEST(Portals, HoldEachSightLineOfTrees) {
    Sweep sweep;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        const glm::dvec3 center = seed % 3 == 0 ? glm::dvec3(1e4, -3e4, 2e4) : glm::dvec3(0.0);
        const CellSpace space = treeSpace(randomLeafTree(seed, 9, center, seed % 2 == 0));
        sweep.run(space, seed, 150, kRays, space.tolerance / 32, 1);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(sweep.answers, 3000u);
    EXPECT_GT(sweep.tally.rays, 1000000u);
    EXPECT_GT(sweep.tally.steps, sweep.tally.rays + 500000);
    EXPECT_LE(sweep.cells[1], sweep.cells[0]);
    EXPECT_LE(sweep.cells[2], sweep.cells[1]);
}

/// The cells that a view sees, which it knows.
std::vector<uint32_t> seen(const PortalGraph& graph, const KnownView& known, const PortalSettings& settings) {
    PortalFlood flood;
    EXPECT_TRUE(flood.run(graph, known.view, settings));
    return cellsOf(flood);
}

bool holds(const std::vector<uint32_t>& cells, const std::vector<uint32_t>& part) {
    return std::includes(cells.begin(), cells.end(), part.begin(), part.end());
}

glm::dmat4 smallNear(double fov) { return perspective(fov, 1.3, 1e-3); }

/// A hall, two ways out of it around a pillar, a second hall behind, and a closet at each end of that:
///
///     0 0 0 0 2 3 5
///     0 0 0 0 # 3 #
///     0 0 0 0 1 3 4
struct TwoWays {
    CellSpace space;

    TwoWays() {
        const auto room = [&](double x0, double x1, double z0, double z1) {
            addRegion(space, {{x0, 0, z0}, {x1, 1, z1}});
            return space.graph.cells++;
        };
        room(-4, 1, 0, 3);
        room(1, 2, 0, 1);
        room(1, 2, 2, 3);
        room(2, 3, 0, 3);
        room(3, 4, 0, 1);
        room(3, 4, 2, 3);
        const auto hole = [&](uint32_t west, uint32_t east, double x, double z0) {
            const glm::dvec3 outline[4] = {{x, 0, z0}, {x, 0, z0 + 1}, {x, 1, z0 + 1}, {x, 1, z0}};
            space.graph.addPortal(west, east, outline);
            if (!(space.graph.portals.back().plane.x < 0)) ADD_FAILURE() << "the outline is the wrong way round";
        };
        hole(0, 1, 1, 0);
        hole(0, 2, 1, 2);
        hole(1, 3, 2, 0);
        hole(2, 3, 2, 2);
        hole(3, 4, 3, 0);
        hole(3, 5, 3, 2);
    }
};

// E5: what is marked once must be entered again with the other window, or cell 4 or cell 5 is lost.
TEST(Portals, EnterACellAgainForItsOtherWindow) {
    const TwoWays world;
    const PortalGraph graph(world.space);
    const KnownView known = makeView({-3, 0.5, 1.5}, {1, 0, 0}, smallNear(1.2));
    for (const PortalWindows windows : kKinds) {
        EXPECT_EQ(seen(graph, known, {.windows = windows}), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}))
            << kWindowNames[static_cast<int>(windows)];
    }
}

// E5: an eye in a portal's plane sees through it whatever is behind, and back.
TEST(Portals, TakeTheWholeWindowWhereTheEyeIsInThePortal) {
    const TwoWays world;
    const PortalGraph graph(world.space);
    for (const double off : {0.0, 1e-13, -1e-13, 1e-6, -1e-6, 1e-3, -1e-3})
        for (const PortalWindows windows : kKinds) {
            const KnownView east = makeView({1 + off, 0.5, 2.5}, {1, 0, 0}, smallNear(1.2)),
                            west = makeView({1 + off, 0.5, 2.5}, {-1, 0, 0}, smallNear(1.2));
            EXPECT_TRUE(holds(seen(graph, east, {.windows = windows}), {2, 3, 5})) << off;
            EXPECT_TRUE(holds(seen(graph, west, {.windows = windows}), {0})) << off;
        }
}

// E6: the hole between 1 and 3 is not in view, and yet 3 is: through 2.
TEST(Portals, SeeACellThroughAnyOfItsPortals) {
    const TwoWays world;
    const PortalGraph graph(world.space);
    const KnownView known = makeView({0, 0.5, 2.5}, {1, 0, 0}, smallNear(0.2));
    for (const PortalWindows windows : kKinds) {
        EXPECT_EQ(seen(graph, known, {.windows = windows}), (std::vector<uint32_t>{0, 2, 3, 5}))
            << kWindowNames[static_cast<int>(windows)];
    }
}

// Cells 2 and 3 lie on 0 and 1, from 0 to 1 there is a wall, and what is within a hundredth of a cell is in it. An eye a
// little below 2 is in 0 first, so 1 and 4 behind it have their turn before 3: and yet they are seen through 2 and 3, on a line along their
// floor.
TEST(Portals, EnterCellsAgainThatAreReachedAfterTheirTurn) {
    CellSpace space;
    space.tree.bounds = {{0, 0, -1}, {3, 1, 1}};
    constexpr uint32_t kLeaf = LeafTreeNode::kLeaf;
    space.tree.nodes.push_back({{0, 0, 1, 0}, {1, 2}});
    space.tree.nodes.push_back({{1, 0, 0, -1}, {kLeaf + 0, 3}});
    space.tree.nodes.push_back({{1, 0, 0, -1}, {kLeaf + 2, kLeaf + 3}});
    space.tree.nodes.push_back({{1, 0, 0, -2}, {kLeaf + 1, kLeaf + 4}});
    space.tree.contents.assign(5, LeafContents::kEmpty);
    space.graph.cells = 5;
    space.tolerance = 0.01;
    const glm::dvec3 between[4] = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
    const glm::dvec3 floor[4] = {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    space.graph.addPortal(2, 3, between);
    const glm::dvec3 behind[4] = {{2, 0, -1}, {2, 0, 0}, {2, 1, 0}, {2, 1, -1}};
    space.graph.addPortal(3, 1, floor);
    space.graph.addPortal(1, 4, behind);
    ASSERT_LT(space.graph.portals[0].plane.x, 0);
    ASSERT_GT(space.graph.portals[1].plane.z, 0);
    const PortalGraph graph(space);
    for (const PortalWindows windows : kKinds) {
        const KnownView close = makeView({0.1, 0.5, -0.005}, {1, 0, 0}, smallNear(1));
        EXPECT_EQ(seen(graph, close, {.windows = windows}), (std::vector<uint32_t>{0, 1, 2, 3, 4}))
            << kWindowNames[static_cast<int>(windows)];
        // Not so an eye that is certainly below, or above.
        const KnownView below = makeView({0.1, 0.5, -0.1}, {1, 0, 0}, smallNear(1));
        EXPECT_EQ(seen(graph, below, {.windows = windows}), (std::vector<uint32_t>{0}));
    }
}

TEST(Portals, SayNothingWhereTheEyeIsInNoCell) {
    const TwoWays world;
    const PortalGraph graph(world.space);
    PortalFlood flood;
    EXPECT_FALSE(flood.run(graph, makeView({1.5, 0.5, 1.5}, {1, 0, 0}, smallNear(1)).view));  // in the pillar
    EXPECT_FALSE(flood.run(graph, makeView({9, 0.5, 1.5}, {1, 0, 0}, smallNear(1)).view));    // beyond
    EXPECT_FALSE(
        flood.run(graph, makeView({0.9, 0.5, 1.5}, {1, 0, 0}, perspective(1, 1, 0.2)).view));  // near plane in it
    EXPECT_TRUE(flood.run(graph, makeView({0.7, 0.5, 1.5}, {1, 0, 0}, perspective(1, 1, 0.2)).view));
    // The near plane goes through a hole: both cells are starts.
    ASSERT_TRUE(flood.run(graph, makeView({0.9, 0.5, 2.5}, {1, 0, 0}, perspective(1, 1, 0.2)).view));
    EXPECT_EQ(flood.cells()[0].from, ~0u);
    EXPECT_EQ(flood.cells()[1].from, ~0u);
}

TEST(Portals, CountWhatLimitsLeaveOut) {
    const TwoWays world;
    const PortalGraph graph(world.space);
    const KnownView known = makeView({-3, 0.5, 1.5}, {1, 0, 0}, smallNear(1.2));
    for (const PortalWindows windows : kKinds) {
        PortalFlood flood;
        ASSERT_TRUE(flood.run(graph, known.view, {.windows = windows, .depth = 1}));
        EXPECT_EQ(cellsOf(flood), (std::vector<uint32_t>{0, 1, 2}));
        EXPECT_GT(flood.stats().too_deep, 0u);
        ASSERT_TRUE(flood.run(graph, known.view, {.windows = windows, .depth = 3}));
        EXPECT_EQ(flood.stats().too_deep, 0u);
        EXPECT_FALSE(flood.run(graph, known.view, {.windows = windows, .work = 2}));
        EXPECT_TRUE(flood.stats().work_spent);
        EXPECT_TRUE(flood.cells().empty());
        ASSERT_TRUE(flood.run(graph, known.view, {.windows = windows}));
        EXPECT_FALSE(flood.stats().work_spent);
    }
}

TEST(Portals, EnterRowsThatMayBeSeenAlone) {
    TwoWays world;
    world.space.row_of_cell = {0, 1, 2, 3, CellGraph::kNoCell, 65};
    const PortalGraph graph(world.space);
    const KnownView known = makeView({-3, 0.5, 1.5}, {1, 0, 0}, smallNear(1.2));
    const auto ask = [&](std::vector<uint64_t> rows) {
        PortalFlood flood;
        EXPECT_TRUE(flood.run(graph, known.view, {}, {}, rows));
        return cellsOf(flood);
    };
    EXPECT_EQ(ask({}), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(ask({0xf, 0}), (std::vector<uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(ask({0xf, 2}), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(ask({0x9, 2}), (std::vector<uint32_t>{0}));
    EXPECT_EQ(ask({0xd}), (std::vector<uint32_t>{0, 2, 3}));  // 4 has no row, but is not seen through 2
}

TEST(Portals, TellWhereEachCellIsSeenFrom) {
    const CellSpace space = gridSpace(5, {.rooms = {4, 4, 2}});
    const PortalGraph graph(space);
    Random random(5);
    const Box3d box = boxOf(space);
    size_t links = 0;
    for (int i = 0; i < 200; ++i) {
        const KnownView known = makeView(randomIn(random, box), randomDirection(random), smallNear(2));
        for (const PortalWindows windows : kKinds) {
            PortalFlood flood;
            if (!flood.run(graph, known.view, {.windows = windows})) continue;
            for (const SeenCell& cell : flood.cells()) {
                if (cell.from == ~0u) continue;
                ASSERT_LT(cell.from, flood.cells().size());
                ASSERT_LT(cell.portal, space.graph.portals.size());
                const CellPortal& portal = space.graph.portals[cell.portal];
                const uint32_t from = flood.cells()[cell.from].cell;
                EXPECT_TRUE((portal.cells[0] == from && portal.cells[1] == cell.cell) ||
                            (portal.cells[1] == from && portal.cells[0] == cell.cell));
                EXPECT_LE(cell.left, cell.right);
                EXPECT_LE(cell.bottom, cell.top);
                ++links;
            }
        }
    }
    EXPECT_GT(links, 500u);
}

TEST(Portals, TighterWindowsSeeNoOtherCells) {
    uint64_t counts[3] = {0, 0, 0};
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        const CellSpace space = seed % 2 ? gridSpace(seed, {.rooms = {5, 5, 2}})
                                         : treeSpace(randomLeafTree(seed, 9, glm::dvec3(0.0), seed % 4 == 0));
        const PortalGraph graph(space);
        Random random(seed);
        const Box3d box = boxOf(space);
        PortalFlood flood;
        for (int i = 0; i < 200; ++i) {
            const KnownView known = randomView(random, hardPoint(random, space, box), 1);
            std::vector<uint32_t> cells[3];
            bool known_all = true;
            for (int kind = 0; kind < 3; ++kind) {
                known_all &= flood.run(graph, known.view, {.windows = kKinds[kind]});
                cells[kind] = cellsOf(flood);
            }
            if (!known_all) continue;
            for (int kind = 0; kind < 3; ++kind) counts[kind] += cells[kind].size();
            EXPECT_TRUE(holds(cells[0], cells[1])) << "seed " << seed << ", view " << i;
            EXPECT_TRUE(holds(cells[1], cells[2])) << "seed " << seed << ", view " << i;
        }
    }
    EXPECT_LT(counts[1], counts[0]);
    EXPECT_LT(counts[2], counts[1]);
}

/// Depth first: each portal clipped by the planes through the eye and the edges of the one before, which lie `out` of
/// their place, outward, at the corners. Of all ways through the graph; the eye is in one cell.
class ClippingOracle {
public:
    ClippingOracle(const CellGraph& graph, const glm::dvec3& eye, double out) : graph_(graph), eye_(eye), out_(out) {
        of_cell_.resize(graph.cells);
        for (uint32_t i = 0; i < graph.portals.size(); ++i)
            for (const uint32_t cell : graph.portals[i].cells) of_cell_[cell].push_back(i);
        reached.resize(graph.cells, false);
    }

    void enter(uint32_t cell, const std::vector<glm::dvec4>& planes, int depth) {
        reached[cell] = true;
        if (depth == 40) return;
        for (const uint32_t i : of_cell_[cell]) {
            const CellPortal& portal = graph_.portals[i];
            const double side = portal.cells[0] == cell ? 1 : -1;
            if (!(side * (glm::dot(glm::dvec3(portal.plane), eye_) + portal.plane.w) > 0)) continue;
            const auto outline = graph_.outline(portal);
            std::vector<glm::dvec3> left(outline.begin(), outline.end());
            if (side < 0) std::reverse(left.begin(), left.end());
            for (const glm::dvec4& plane : planes) cut(left, plane);
            if (left.size() < 3) continue;
            std::vector<glm::dvec4> next;
            for (size_t k = 0; k < left.size(); ++k) {
                const glm::dvec3 a = left[k] - eye_, b = left[(k + 1) % left.size()] - eye_;
                const glm::dvec3 normal = glm::cross(b, a);  // counter-clockwise as seen: inward
                const double length = glm::length(normal);
                if (length > 1e-9 * glm::length(a) * glm::length(b)) next.emplace_back(normal / length, out_);
            }
            enter(portal.cells[side > 0 ? 1 : 0], next, depth + 1);
        }
    }

    std::vector<bool> reached;

private:
    void cut(std::vector<glm::dvec3>& outline, const glm::dvec4& plane) const {
        std::vector<glm::dvec3> left;
        for (size_t k = 0; k < outline.size(); ++k) {
            const glm::dvec3 &a = outline[k], &b = outline[(k + 1) % outline.size()];
            const double at_a = glm::dot(glm::dvec3(plane), a - eye_) + plane.w;
            const double at_b = glm::dot(glm::dvec3(plane), b - eye_) + plane.w;
            if (at_a >= 0) left.push_back(a);
            if ((at_a >= 0) != (at_b >= 0)) left.push_back(a + at_a / (at_a - at_b) * (b - a));
        }
        outline = left;
    }

    const CellGraph& graph_;
    glm::dvec3 eye_;
    double out_;
    std::vector<std::vector<uint32_t>> of_cell_;
};

TEST(Portals, PolygonsAreWhatClippingLeaves) {
    uint64_t exact = 0, answered = 0, views = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        const CellSpace space = gridSpace(seed, {.rooms = {5, 5, 2}, .doors = 0.9});
        const PortalGraph graph(space);
        Random random(seed);
        PortalFlood flood;
        for (int i = 0; i < 100; ++i) {
            const uint32_t cell = static_cast<uint32_t>(random.below(space.graph.cells));
            const glm::dvec3 eye =
                randomIn(random, {space.regions[cell].bounds.min + 0.05, space.regions[cell].bounds.max - 0.05});
            KnownView known = makeView(eye, randomDirection(random), perspective(1.5, 1.2, 1e-3));
            known.view.jitter = 0;
            ASSERT_TRUE(flood.run(graph, known.view, {.windows = PortalWindows::kPolygons}));
            std::vector<glm::dvec4> sides;
            for (int k = 0; k < 4; ++k) {
                // Counter-clockwise: the corners of the view, each with the next.
                constexpr double kX[5] = {-1, 1, 1, -1, -1}, kY[5] = {-1, -1, 1, 1, -1};
                const glm::dvec3 a = sightLineAt(known, kX[k], kY[k]).direction;
                const glm::dvec3 b = sightLineAt(known, kX[k + 1], kY[k + 1]).direction;
                sides.emplace_back(glm::normalize(glm::cross(b, a)), 0);
            }
            ClippingOracle least(space.graph, eye, -1e-6), most(space.graph, eye, 1e-6);
            least.enter(cell, sides, 0);
            most.enter(cell, sides, 0);
            const std::vector<uint32_t> cells = cellsOf(flood);
            for (uint32_t k = 0; k < space.graph.cells; ++k) {
                const bool seen = std::binary_search(cells.begin(), cells.end(), k);
                if (least.reached[k]) { EXPECT_TRUE(seen) << "seed " << seed << ", view " << i << ", cell " << k; }
                if (!most.reached[k] && flood.stats().joined == 0) {
                    EXPECT_FALSE(seen) << "seed " << seed << ", view " << i << ", cell " << k;
                }
                exact += least.reached[k];
                answered += seen;
            }
            ++views;
        }
    }
    EXPECT_GT(exact, 2 * views);
    EXPECT_LT(static_cast<double>(answered), 1.01 * static_cast<double>(exact));
}

/// The open part of a portal's outline along a slide begins here.
double leastOpen(const CellSpace& space, const CellPortal& portal, const glm::dvec3& slide, double open) {
    double low = INFINITY, high = -INFINITY;
    for (const glm::dvec3& point : space.graph.outline(portal)) {
        low = std::min(low, glm::dot(slide, point));
        high = std::max(high, glm::dot(slide, point));
    }
    return high - open * (high - low);
}

TEST(Portals, SeeThroughDoorsAsFarAsTheyAreOpen) {
    RayTally tally;
    uint64_t open_cells = 0, shut_cells = 0, blocked = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        CellSpace space = gridSpace(seed, {.rooms = {4, 4, 2}});
        Random random(seed);
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> portal_between;
        for (uint32_t i = 0; i < space.graph.portals.size(); ++i) {
            CellPortal& portal = space.graph.portals[i];
            portal_between[{portal.cells[0], portal.cells[1]}] = i;
            portal_between[{portal.cells[1], portal.cells[0]}] = i;
            if (random.below(5) == 0) continue;
            portal.door = static_cast<uint32_t>(space.doors.size());
            const auto outline = space.graph.outline(portal);
            const glm::dvec3 slide = random.below(5) == 0   ? glm::dvec3(0.0)
                                     : random.below(2) == 0 ? outline[1] - outline[0]
                                                            : 3.0 * randomDirection(random);
            space.doors.push_back({"", CellDoor::kNoKey, slide});
        }
        const PortalGraph graph(space);
        const GraphRays rays(space.graph, 1e-9);
        PortalJudge judge(space, rays);
        PortalFlood flood;
        std::vector<DoorState> doors(space.doors.size());
        for (int i = 0; i < 100; ++i) {
            const KnownView known = randomView(random, hardPoint(random, space, boxOf(space)), 1);
            if (!flood.run(graph, known.view)) continue;
            open_cells += flood.cells().size();
            for (DoorState& door : doors)
                door.open = random.below(3) == 0 ? 0.0f : random.below(2) ? 1.0f : static_cast<float>(random.uniform());
            for (const PortalWindows windows : kKinds) {
                ASSERT_TRUE(flood.run(graph, known.view, {.windows = windows}, doors));
                judge.judge(known, flood, random, 200, tally, [&](uint32_t from, uint32_t to, const glm::dvec3& point) {
                    const CellPortal& portal = space.graph.portals[portal_between[{from, to}]];
                    if (portal.door == CellPortal::kNone) return false;
                    const double open = doors[portal.door].open;
                    const glm::dvec3 slide = space.doors[portal.door].slide;
                    const bool shut = open <= 0 || (open < 1 && slide != glm::dvec3(0.0) &&
                                                    glm::dot(slide, point) < leastOpen(space, portal, slide, open));
                    blocked += shut;
                    return shut;
                });
                ASSERT_EQ(tally.missed, 0u) << "seed " << seed << ", view " << i << ": " << tally.example;
                if (windows == PortalWindows::kOctagons) shut_cells += flood.cells().size();
            }
            for (DoorState& door : doors) door.open = 0;
            ASSERT_TRUE(flood.run(graph, known.view, {}, doors));
            for (const SeenCell& cell : flood.cells())
                if (cell.from != ~0u) { EXPECT_EQ(space.graph.portals[cell.portal].door, CellPortal::kNone); }
        }
    }
    EXPECT_LT(shut_cells, open_cells);
    EXPECT_GT(blocked, 10000u);
    EXPECT_GT(tally.steps, tally.rays);
}

// The closet's only door is half shut: seen from straight ahead, the half that the leaf has not reached is left.
TEST(Portals, LeaveThePartThatTheLeafHasNotReached) {
    CellSpace space;
    addRegion(space, {{0, 0, 0}, {2, 1, 1}});
    addRegion(space, {{2, 0, 0}, {3, 1, 1}});
    space.graph.cells = 2;
    const glm::dvec3 outline[4] = {{2, 0, 0}, {2, 0, 1}, {2, 1, 1}, {2, 1, 0}};
    space.graph.addPortal(0, 1, outline, 0);
    space.doors.push_back({"lift", CellDoor::kNoKey, {0, 0.1, 0}});
    const PortalGraph graph(space);
    KnownView known = makeView({1, 0.5, 0.5}, {1, 0, 0}, smallNear(1.6));
    known.view.view = lookAt(known.eye, {2, 0.5, 0.5}, {0, 1, 0});
    const DoorState half[1] = {{0.25f}};
    PortalFlood flood;
    ASSERT_TRUE(flood.run(graph, known.view, {}, half));
    ASSERT_EQ(flood.cells().size(), 2u);
    // From y = 0.75 on: a quarter above the eye at a distance of 1.
    EXPECT_NEAR(flood.cells()[1].bottom, 0.25 / std::tan(0.8), 1e-6);
    EXPECT_NEAR(flood.cells()[1].top, 0.5 / std::tan(0.8), 1e-6);
}

TEST(Portals, GoThroughOutsideAndBack) {
    // Two houses that face each other across nothing: each has a hole to the outside. From there walls hide nothing, as
    // they may be drawn from within alone: who looks out of a hole sees all that lies in that window.
    CellSpace space;
    addRegion(space, {{0, 0, 0}, {1, 1, 1}});
    addRegion(space, {{3, 0, 0}, {4, 1, 1}});
    space.regions.push_back({});
    space.graph.cells = 3;
    space.outside = 2;
    const auto hole = [&](uint32_t cell, double x, bool east) {
        std::vector<glm::dvec3> outline = {{x, 0.2, 0.2}, {x, 0.2, 0.8}, {x, 0.8, 0.8}, {x, 0.8, 0.2}};
        if (!east) std::reverse(outline.begin(), outline.end());
        space.graph.addPortal(cell, 2, outline);
    };
    hole(0, 1, true);
    hole(1, 3, false);
    const PortalGraph graph(space);
    for (const PortalWindows windows : kKinds) {
        PortalFlood flood;
        ASSERT_TRUE(flood.run(graph, makeView({0.5, 0.5, 0.5}, {1, 0, 0}, smallNear(1)).view, {.windows = windows}));
        EXPECT_EQ(cellsOf(flood), (std::vector<uint32_t>{0, 1, 2}));
        for (const SeenCell& seen : flood.cells())
            if (seen.cell != 0) { EXPECT_GT(seen.plane_count, 0u) << "through the hole alone"; }
        ASSERT_TRUE(flood.run(graph, makeView({2, 0.5, 0.5}, {-1, 0, 0}, smallNear(1)).view, {.windows = windows}));
        EXPECT_EQ(cellsOf(flood), (std::vector<uint32_t>{0, 1, 2}));
        ASSERT_TRUE(flood.run(graph, makeView({0.5, 0.5, 0.5}, {-1, 0, 0}, smallNear(1)).view, {.windows = windows}));
        EXPECT_EQ(cellsOf(flood), (std::vector<uint32_t>{0}));
    }
}

TEST(Portals, AreTheSameWithEachInstructionSet) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const CellSpace space = seed % 2 ? gridSpace(seed, {.rooms = {4, 4, 2}})
                                         : treeSpace(randomLeafTree(seed, 9, glm::dvec3(0.0), false));
        const PortalGraph graph(space);
        std::vector<std::vector<double>> answers;
        const int targets = forEachTarget([&](const std::string&) {
            std::vector<double> all;
            Random random(seed);
            PortalFlood flood;
            for (int i = 0; i < 100; ++i) {
                const KnownView known = randomView(random, hardPoint(random, space, boxOf(space)), 1);
                for (const PortalWindows windows : kKinds) {
                    all.push_back(flood.run(graph, known.view, {.windows = windows}));
                    for (const SeenCell& cell : flood.cells()) {
                        all.push_back(cell.cell);
                        all.push_back(cell.left);
                        all.push_back(cell.top);
                    }
                    for (const glm::dvec4& plane : flood.planes())
                        for (int k = 0; k < 4; ++k) all.push_back(plane[k]);
                }
            }
            answers.push_back(std::move(all));
        });
        EXPECT_GE(targets, 1);
        for (const auto& answer : answers) EXPECT_EQ(answer, answers[0]) << "seed " << seed;
        EXPECT_GT(answers[0].size(), 2000u);
    }
}

}  // namespace
}  // namespace sightline::test
