// What is outside: sealed rooms keep their inside, a hole is reported with its way, and nothing is lost.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/outside.h"

#include <filesystem>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "sightline/tools/import/quake/quake_map.h"
#include "sightline/tools/scene/text_file.h"
#include "tests/bake/brushes/made_brushes.h"

namespace sightline::test {
using namespace bake;
using namespace tools;
namespace {

void addLight(BrushMaker& maker, const std::string& origin) {
    maker.entity({{"classname", "light"}, {"origin", origin}});
}

/// Each step of the way keeps out of solid brushes, but for touching them, and the last point is on the bounds.
void expectWay(const QuakeMap& map, const BrushTree& brushes, const MapLeak& leak) {
    ASSERT_GE(leak.path.size(), 2u);
    const std::vector<BrushRole> roles = brushRoles(map).roles;
    for (size_t i = 0; i + 1 < leak.path.size(); ++i)
        for (int k = 0; k <= 100; ++k) {
            const glm::dvec3 point = leak.path[i] + k / 100.0 * (leak.path[i + 1] - leak.path[i]);
            for (const QuakeMapEntity& entity : map.entities) {
                for (const QuakeMapBrush& brush : map.brushesOf(entity)) {
                    if (roles[static_cast<size_t>(&brush - map.brushes.data())] > BrushRole::kSky) continue;
                    ASSERT_LT(depthIn(map, brush, point), 0.05);
                }
            }
        }
    const Box3d& bounds = brushes.tree.bounds;
    double least = 1e30;
    for (int axis = 0; axis < 3; ++axis)
        least = std::min({least, std::abs(leak.path.back()[axis] - bounds.min[axis]),
                          std::abs(leak.path.back()[axis] - bounds.max[axis])});
    EXPECT_LT(least, 1e-6);
}

TEST(Outside, IsNotASealedRoom) {
    for (const double angle : {0.0, 0.3, 1.1}) {
        const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(glm::dvec3(1, 2, 3))));
        BrushMaker maker;
        maker.room({-100, -100, -100}, {100, 100, 100}, 16, -1, turn);
        addLight(maker, "1 2 3");
        const BrushTree brushes = treeOfBrushes(maker.map);
        const MapCells cells = cellsInside(maker.map, brushes);
        EXPECT_TRUE(cells.leaks.empty()) << angle;
        EXPECT_EQ(cells.standing, 1u);
        EXPECT_EQ(cells.reached, 0u);
        EXPECT_GT(cells.outside, 0u);
        EXPECT_EQ(cells.graph.cells, 1u) << angle;
        EXPECT_TRUE(cells.graph.portals.empty());
    }
}

TEST(Outside, LeaksThroughAMissingWall) {
    for (int wall = 0; wall < 6; ++wall) {
        BrushMaker maker;
        maker.room({-100, -100, -100}, {100, 100, 100}, 16, wall);
        maker.room({400, -100, -100}, {600, 100, 100}, 16);  // another that is sealed
        addLight(maker, "500 0 0");
        addLight(maker, "1 2 3");
        const BrushTree brushes = treeOfBrushes(maker.map);
        const MapCells cells = cellsInside(maker.map, brushes);
        ASSERT_EQ(cells.leaks.size(), 1u);
        EXPECT_EQ(cells.leaks[0].what, "light");
        EXPECT_EQ(cells.leaks[0].entity, 2u);
        EXPECT_EQ(cells.leaks[0].path[0], glm::dvec3(1, 3, -2));
        EXPECT_EQ(cells.standing, 2u);
        EXPECT_EQ(cells.reached, 1u);
        EXPECT_EQ(cells.graph.cells, cells.outside + 1);  // nothing is lost, and the sealed room is one
        expectWay(maker.map, brushes, cells.leaks[0]);
    }
}

TEST(Outside, IsNotReachedThroughWhatIsTooNarrow) {
    for (const double slit : {0.05, 0.2, 0.5, 8.0}) {
        BrushMaker maker;
        maker.room({-100, -100, -100}, {100, 100, 100}, 16, 0);
        maker.box({-116, -116, -116}, {-100, 0, 116});
        maker.box({-116, slit, -116}, {-100, 116, 116});
        addLight(maker, "1 2 3");
        const BrushTree brushes = treeOfBrushes(maker.map);
        const MapCells cells = cellsInside(maker.map, brushes);
        EXPECT_EQ(cells.leaks.empty(), slit < 0.25) << slit;
        EXPECT_EQ(cells.closed > 0, slit < 0.25) << slit;
        if (!cells.leaks.empty()) expectWay(maker.map, brushes, cells.leaks[0]);
        EXPECT_FALSE(cellsInside(maker.map, brushes, 0).leaks.empty());
    }
}

TEST(Outside, HeedsWhoStandsThere) {
    BrushMaker maker;
    maker.room({-100, -100, -100}, {100, 100, 100}, 16, 0);
    // In a wall, without an origin, with brushes: none of them is a thing that the outside could reach.
    addLight(maker, "0 0 108");
    maker.entity({{"classname", "target"}});
    maker.entity({{"classname", "light"}, {"origin", "0 0"}});
    maker.entity({{"classname", "func_door"}, {"origin", "0 0 0"}});
    maker.box({0, 0, 0}, {8, 8, 8});
    const MapCells cells = cellsInside(maker.map, treeOfBrushes(maker.map));
    EXPECT_EQ(cells.standing, 0u);
    EXPECT_TRUE(cells.leaks.empty());
    EXPECT_EQ(cells.graph.cells, 0u);  // all of it is outside
}

TEST(Outside, StandsBrushesOfAnyPlanes) {
    uint64_t solid = 0, leaks = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        // Sides through points of a small lattice: in a line, facing anywhere, again and again; brushes without end.
        Random random(seed);
        BrushMaker maker;
        maker.map.textures = {"brick", "*water", "sky"};
        const auto point = [&] {
            return glm::dvec3(double(random.below(5)), double(random.below(5)), double(random.below(5))) * 16.0;
        };
        for (uint64_t b = 0; b < 30; ++b) {
            QuakeMapBrush brush{.first_side = static_cast<uint32_t>(maker.map.sides.size())};
            const uint32_t texture = random.below(3) == 0 ? static_cast<uint32_t>(random.below(3)) : 0;
            for (uint64_t k = 1 + random.below(9); k > 0; --k)
                maker.map.sides.push_back({{point(), point(), point()}, texture, 0, 0});
            brush.side_count = static_cast<uint32_t>(maker.map.sides.size()) - brush.first_side;
            maker.map.brushes.push_back(brush);
            ++maker.map.entities.back().brush_count;
        }
        for (int i = 0; i < 5; ++i)
            addLight(maker, std::to_string(random.below(80)) + " " + std::to_string(random.below(80)) + " 33");
        const BrushTree brushes = treeOfBrushes(maker.map);
        std::vector<bool> seen(brushes.tree.nodes.size(), false);
        for (uint32_t n = 0; n < brushes.tree.nodes.size(); ++n)
            for (const uint32_t child : brushes.tree.nodes[n].child) {
                if ((child & LeafTreeNode::kLeaf) != 0) {
                    ASSERT_LT(child & ~LeafTreeNode::kLeaf, brushes.tree.contents.size());
                    continue;
                }
                ASSERT_GT(child, n);
                ASSERT_FALSE(seen.at(child));
                seen[child] = true;
            }
        for (const LeafContents contents : brushes.tree.contents) solid += contents == LeafContents::kSolid;
        const MapCells cells = cellsInside(maker.map, brushes);
        for (const CellPortal& portal : cells.graph.portals) ASSERT_LT(portal.thickness, 1e-9);
        leaks += cells.leaks.size();
    }
    EXPECT_GT(solid, 50u);
    EXPECT_GT(leaks, 5u);
}

TEST(Outside, AWayIsWrittenInTheMapsAxes) {
    MapLeak leak;
    leak.path = {{0, 0, 0}, {16, 0, 0}, {16, 4, -2}};
    EXPECT_EQ(pointFile(leak), "0.000 0.000 0.000\n8.000 0.000 0.000\n16.000 0.000 0.000\n16.000 2.000 4.000\n");
}

TEST(OutsideMaps, SealedOnesAreAndTheLeakyOneIsNot) {
    const std::filesystem::path folder = SIGHTLINE_SHARED_DIR "/maps";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared maps are not there: " << folder;
    size_t maps = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".map") continue;
        const std::string name = entry.path().stem().string();
        const Result<std::string> text = readTextFile(entry.path().string());
        ASSERT_TRUE(text.ok());
        const Result<QuakeMap> map =
            parseQuakeMap({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, name);
        ASSERT_TRUE(map.ok()) << map.error().message;
        const BrushTree brushes = treeOfBrushes(*map);
        const MapCells cells = cellsInside(*map, brushes);
        EXPECT_EQ(cells.leaks.size(), name == "leaky_junction" ? 1u : 0u) << name;
        EXPECT_GT(cells.graph.cells, 300u) << name;
        EXPECT_GT(cells.graph.portals.size(), cells.graph.cells) << name;
        for (const MapLeak& leak : cells.leaks) expectWay(*map, brushes, leak);
        ++maps;
    }
    EXPECT_EQ(maps, 7u);
}

}  // namespace
}  // namespace sightline::test
