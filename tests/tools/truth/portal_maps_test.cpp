// Portals as windows in real maps and in a building: sight lines followed through their cells, doors opened and shut.
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/text_file.h"
#include "tests/bsp/cell_space_fixture.h"
#include "tests/cells/portal_rays.h"
#include "tests/support/random.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

/// In the open, by holes, in their planes and in them.
glm::dvec3 eyeIn(Random& random, const CellSpace& space, double size) {
    const CellPortal& portal = space.graph.portals[random.below(space.graph.portals.size())];
    const glm::dvec3 point = pointInHole(random, space.graph.outline(portal));
    const double off = random.below(4) == 0 ? 0 : size * std::pow(10.0, random.uniform(-9, 0));
    return point + off * randomDirection(random);
}

/// @param rays  to follow, at least
void judgeSpace(const CellSpace& space, const std::string& name, double margin, double size, uint64_t rays,
                bool doors) {
    const PortalGraph graph(space);
    const GraphRays lines(space.graph, margin);
    PortalJudge judge(space, lines);
    PortalFlood flood;
    RayTally tally;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> between;
    for (uint32_t i = 0; i < space.graph.portals.size(); ++i) {
        const CellPortal& portal = space.graph.portals[i];
        between[{portal.cells[0], portal.cells[1]}].push_back(i);
        between[{portal.cells[1], portal.cells[0]}].push_back(i);
    }
    std::vector<DoorState> states(doors ? space.doors.size() : 0);
    Random random(7);
    uint64_t answers = 0, tries = 0;
    for (; tally.rays < rays && tries < rays; ++tries) {
        const KnownView known = randomView(random, eyeIn(random, space, size), size);
        for (DoorState& door : states) door.open = random.below(2) ? 1.0f : 0.0f;
        const auto windows = static_cast<PortalWindows>(tries % 3);
        if (!flood.run(graph, known.view, {.windows = windows}, states)) continue;
        ++answers;
        judge.judge(known, flood, random, 2000, tally, [&](uint32_t from, uint32_t to, const glm::dvec3&) {
            if (states.empty()) return false;
            for (const uint32_t i : between[{from, to}]) {
                const uint32_t door = space.graph.portals[i].door;
                if (door == CellPortal::kNone || states[door].open > 0) return false;
            }
            return true;
        });
        ASSERT_EQ(tally.missed, 0u) << name << ", view " << tries << ", " << kWindowNames[static_cast<int>(windows)]
                                    << ": " << tally.example;
        ASSERT_EQ(tally.solid, 0u) << name << ", view " << tries;
    }
    EXPECT_GE(tally.rays, rays) << name;
    EXPECT_GT(answers, tries / 8) << name;
}

TEST(PortalMaps, HoldEachSightLine) {
    for (const char* name : {"lq_e1m5", "lqdm3", "lq_e2m2", "lq_e4m1"}) {
        const auto map = sharedMap(name);
        if (!map) GTEST_SKIP() << "no maps beside the repository";
        const CellSpace space = treeSpace(map->tree);
        judgeSpace(space, name, space.tolerance / 32, 64, casesToMake(300000, 20000000), false);
        if (HasFatalFailure()) return;
    }
}

TEST(PortalMaps, HoldEachSightLineOfABuilding) {
    const Result<Scene> scene = makeProcedural(testsAreLong() ? "building:1:10" : "building:1:2");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const CellSpace space = sceneSpace(*scene);
    ASSERT_GT(space.doors.size(), 10u);
    judgeSpace(space, "building", 1e-9, 1, casesToMake(300000, 10000000), false);
    if (HasFatalFailure()) return;
    judgeSpace(space, "building with doors", 1e-9, 1, casesToMake(300000, 10000000), true);
}

}  // namespace
}  // namespace sightline::test
