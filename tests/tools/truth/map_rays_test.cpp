// Real maps: what passes from leaf to leaf of a compiled map passes a portal of the graph that is made of its tree.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/tools/truth/graph_rays.h"
#include "sightline/tools/truth/tree_rays.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

TEST(MapRays, PassThePortalsOfTheTree) {
    const std::vector<std::filesystem::path> files = sharedFiles("maps", ".bsp");
    if (files.empty()) GTEST_SKIP() << "no maps beside the repository";
    EXPECT_GE(files.size(), 4u);
    for (const std::filesystem::path& file : files) {
        const std::string name = file.filename().string();
        const Result<QuakeMapFile> map = readQuakeMap(file.string());
        ASSERT_TRUE(map.ok()) << map.error().message;
        TreePortalCounts counts;
        const CellGraph graph = cellsOfTree(map->tree, {}, &counts);
        const TreeRays tree_rays(map->tree);
        const GraphRays graph_rays(graph, counts.tolerance / 32);
        AimedHoles holes;
        for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
        Random random(1);
        TreeWalk walk;
        std::vector<GraphStep> steps;
        size_t compared = 0;
        for (int i = 0; i < 40000; ++i) {
            // Through a hole, or past one of its corners by little: where slivers are.
            const size_t hole = random.below(holes.size());
            const auto outline = holes.outline(hole);
            const glm::dvec3 direction = randomDirection(random);
            glm::dvec3 through = pointInHole(random, outline);
            if (i % 2 == 1)
                through = outline[random.below(outline.size())] +
                          std::pow(10.0, random.uniform(-6, 0)) * randomDirection(random);
            const glm::dvec3 a = through - 64.0 * direction, b = through + 64.0 * direction;
            tree_rays.follow(a, b, walk);
            if (walk.stretches.size() < 2 || !tree_rays.stands(a, b, walk, 0, walk.stretches.size() - 1)) continue;
            graph_rays.follow(graph.cell_of_leaf[walk.stretches[0].leaf], a, b - a, steps);
            // Portals of neighbours overlap by their tolerance: a line there goes on through both, and its steps are a tree.
            uint32_t at = 0;
            for (size_t k = 1; k < walk.stretches.size(); ++k) {
                const uint32_t cell = graph.cell_of_leaf[walk.stretches[k].leaf];
                uint32_t next = at + 1;
                while (next < steps.size() && !(steps[next].before == at && steps[next].cell == cell)) ++next;
                ASSERT_LT(next, steps.size()) << name << ", segment " << i << ", stretch " << k;
                at = next;
            }
            ++compared;
        }
        EXPECT_GT(compared, 10000u) << name;
    }
}

}  // namespace
}  // namespace sightline::test
