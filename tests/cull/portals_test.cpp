// Windows through portals: no sight line passes a cell that is not in the answer, or outside its window.
// SPDX-License-Identifier: MIT
#include "sightline/cull/portals.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "sightline/scene/procedural.h"
#include "tests/cull/portal_rays.h"
#include "tests/space/cell_space_fixture.h"

namespace sightline::test {
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
                std::vector<uint32_t> seen;
                for (const SeenCell& cell : flood.cells()) seen.push_back(cell.cell);
                std::sort(seen.begin(), seen.end());
                cells[kind] += static_cast<uint64_t>(std::unique(seen.begin(), seen.end()) - seen.begin());
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
        sweep.run(space, seed, 150, 200, 1e-8 * settings.size + 1e-12 * largestCoordinate(space.graph), settings.size);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(sweep.answers, 2 * sweep.refused);
    EXPECT_GT(sweep.tally.steps, sweep.tally.rays + 100000);
    EXPECT_LE(sweep.cells[1], sweep.cells[0]);
    EXPECT_LE(sweep.cells[2], sweep.cells[1]);
}

TEST(Portals, HoldEachSightLineOfTrees) {
    Sweep sweep;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        const glm::dvec3 center = seed % 3 == 0 ? glm::dvec3(1e4, -3e4, 2e4) : glm::dvec3(0.0);
        const CellSpace space = treeSpace(randomLeafTree(seed, 9, center, seed % 2 == 0));
        sweep.run(space, seed, 150, 200, space.tolerance / 32, 1);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(sweep.answers, 3000u);
    EXPECT_GT(sweep.tally.steps, sweep.tally.rays + 100000);
    EXPECT_LE(sweep.cells[1], sweep.cells[0]);
    EXPECT_LE(sweep.cells[2], sweep.cells[1]);
}

}  // namespace
}  // namespace sightline::test
