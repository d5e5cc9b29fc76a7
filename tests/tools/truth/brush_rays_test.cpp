// Segments through brushes: they stop at half-spaces, and they convict trees and rows that the brushes do not bear out.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/brush_rays.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/bake/brushes/outside.h"
#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "tests/support/files.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace bake;
using namespace tools;
namespace {

/// A box in the file's axes.
std::string boxText(int x0, int y0, int z0, int x1, int y1, int z1, const std::string& texture = "wall") {
    const std::string tail = " " + texture + " 0 0 0 1 1\n";
    return "{\n" + fmt::format("( {} 0 0 ) ( {} 0 1 ) ( {} 1 0 )", x1, x1, x1) + tail +
           fmt::format("( {} 0 0 ) ( {} 1 0 ) ( {} 0 1 )", x0, x0, x0) + tail +
           fmt::format("( 0 {} 0 ) ( 1 {} 0 ) ( 0 {} 1 )", y1, y1, y1) + tail +
           fmt::format("( 0 {} 0 ) ( 0 {} 1 ) ( 1 {} 0 )", y0, y0, y0) + tail +
           fmt::format("( 0 0 {} ) ( 0 1 {} ) ( 1 0 {} )", z1, z1, z1) + tail +
           fmt::format("( 0 0 {} ) ( 1 0 {} ) ( 0 1 {} )", z0, z0, z0) + tail + "}\n";
}

/// Two rooms of 128 with a wall between them, which has a door 32 wide, and a pillar in each room.
/// @param stray  one more brush stands so far off; 0: none
std::string roomsText(bool with_door = true, int stray = 0) {
    std::string text = "// Game: Quake\n{\n\"classname\" \"worldspawn\"\n";
    text += boxText(-16, -16, -16, 288, 144, 0) + boxText(-16, -16, 128, 288, 144, 144);
    text += boxText(-16, -16, 0, 0, 144, 128) + boxText(272, -16, 0, 288, 144, 128);
    text += boxText(0, -16, 0, 272, 0, 128) + boxText(0, 128, 0, 272, 144, 128);
    text += boxText(128, 0, 0, 144, 48, 128) + boxText(128, 80, 0, 144, 128, 128);
    if (!with_door) text += boxText(128, 48, 0, 144, 80, 128);
    text += boxText(32, 32, 0, 48, 96, 128) + boxText(208, 16, 0, 224, 64, 128);
    if (stray != 0) text += boxText(stray, 0, 0, stray + 16, 16, 16);
    return text + boxText(100, 100, 40, 110, 110, 50, "clip") +
           "}\n{\n\"classname\" \"light\"\n\"origin\" \"64 16 64\"\n}\n";
}

struct Judged {
    QuakeMap map;
    std::string text;
    BrushTree brushes;
    CellGraph graph;
    BitMatrix visible;

    explicit Judged(const std::string& of) : text(of) {
        const Result<QuakeMap> read =
            parseQuakeMap({reinterpret_cast<const unsigned char*>(text.data()), text.size()}, "test.map");
        EXPECT_TRUE(read.ok()) << read.error().message;
        map = *read;
        brushes = treeOfBrushes(map);
        graph = cellsInside(map, brushes).graph;
        visible = bakeCellVisibility(graph).visible;
    }
    Result<BrushRays> rays() const {
        std::vector<uint8_t> stops;
        for (const BrushRole role : brushes.roles.roles) stops.push_back(role <= BrushRole::kSky);
        return BrushRays::read(text, stops, 0.01);
    }
    BrushReport judge(uint64_t segments, uint64_t seed = 1) const {
        const Result<BrushRays> read = rays();
        EXPECT_TRUE(read.ok()) << read.error().message;
        AimedHoles holes;
        for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
        return checkBrushRows(*read, brushes.tree, visible, graph.cell_of_leaf, holes,
                              {.seed = seed, .segments = segments});
    }
};

TEST(BrushRays, StopAtBrushes) {
    const Judged rooms(roomsText());
    const Result<BrushRays> rays = rooms.rays();
    ASSERT_TRUE(rays.ok()) << rays.error().message;
    EXPECT_EQ(rays->brushes(), 10u) << "a clip stops nothing";
    EXPECT_NEAR(rays->growth(3), 0.02, 1e-6);
    EXPECT_NEAR(rays->growth(8), 0.02, 1e-6) << "a pillar";
    // In the file's axes: from (16, 64, 64) along x to the pillar at 32.
    EXPECT_NEAR(rays->follow({16, 64, -64}, {116, 64, -64}), (16 - rays->growth(8)) / 100, 1e-9);
    EXPECT_EQ(rays->follow({64, 64, -64}, {200, 64, -72}), 1);  // through the door
    EXPECT_EQ(rays->follow({40, 64, -64}, {0, 64, -64}), 0);    // from within the pillar
    EXPECT_LT(rays->follow({64, 64, -16}, {200, 64, -16}), 0.5);
    EXPECT_EQ(rays->follow({105, 45, -95}, {105, 45, -115}), 1);  // through the clip
    // Against all brushes one by one.
    Random random(7);
    for (int i = 0; i < 3000; ++i) {
        const auto point = [&] {
            return glm::dvec3(random.uniform(-10, 280), random.uniform(-10, 140), random.uniform(-140, 10));
        };
        const glm::dvec3 a = point(), b = point();
        double first = 1;
        size_t stops = 0;
        for (const QuakeMapBrush& brush : rooms.map.brushes) {
            if (rooms.map.textures[rooms.map.sidesOf(brush)[0].texture] == "clip") continue;
            const double growth = rays->growth(stops++);
            double in = 0, out = 1;
            for (const QuakeMapSide& side : rooms.map.sidesOf(brush)) {
                const glm::dvec3 n =
                    glm::normalize(glm::cross(side.points[0] - side.points[1], side.points[2] - side.points[1]));
                const double at = glm::dot(n, a - side.points[0]) - growth, slope = glm::dot(n, b - a);
                if (slope < 0) in = std::max(in, -at / slope);
                else if (slope > 0) out = std::min(out, -at / slope);
                else if (at > 0) in = 2;
            }
            if (in <= out) first = std::min(first, in);
        }
        ASSERT_NEAR(rays->follow(a, b), first, 1e-9) << i;
    }
}

TEST(BrushRays, FindNothingInARightTree) {
    for (const bool door : {true, false}) {
        const Judged rooms(roomsText(door));
        const BrushReport report = rooms.judge(40000);
        EXPECT_GT(report.rows.segments, 10000u);
        EXPECT_GT(report.rows.pairs, report.rows.segments);
        EXPECT_EQ(report.rows.misses, 0u);
        EXPECT_TRUE(report.solid.empty());
    }
}

TEST(BrushRays, ConvictATreeThatIsSolidWhereNoBrushIs) {
    const Judged right(roomsText());
    size_t open = 0, convicted = 0;
    for (uint32_t leaf = 0; leaf < right.brushes.tree.contents.size(); ++leaf) {
        if (right.graph.cell_of_leaf[leaf] == CellGraph::kNoCell) continue;
        Judged wrong = right;
        wrong.brushes.tree.contents[leaf] = leaf % 2 != 0 ? LeafContents::kSolid : LeafContents::kSky;
        const BrushReport report = wrong.judge(8000, leaf);
        ++open;
        ASSERT_LE(report.solid.size(), 1u);
        if (report.solid.empty()) continue;
        EXPECT_EQ(report.solid[0].row, leaf);
        ++convicted;
    }
    EXPECT_GE(open, 5u);
    EXPECT_EQ(convicted, open);
}

TEST(BrushRays, ConvictATreeWithAShiftedPlane) {
    const Judged right(roomsText());
    size_t convicted = 0, moved = 0;
    for (uint32_t node = 0; node < right.brushes.tree.nodes.size(); ++node)
        for (const double by : {-3.0, 3.0}) {
            Judged wrong = right;
            wrong.brushes.tree.nodes[node].plane.w += by;
            const BrushReport report = wrong.judge(20000, node);
            ++moved;
            convicted += !report.solid.empty() || report.rows.misses > 0;
        }
    // Of each plane with solid on one side one of the two shifts makes space solid.
    EXPECT_GE(3 * convicted, moved) << moved;
}

/// The tree and the rows of another map, in which the door is walled up: the tree's own rays find nothing wrong.
void judgeWithoutADoor(int stray) {
    const Judged walled(roomsText(false, stray));
    Judged wrong = walled;
    wrong.text = roomsText(true, stray);
    const Result<QuakeMap> map =
        parseQuakeMap({reinterpret_cast<const unsigned char*>(wrong.text.data()), wrong.text.size()}, "test.map");
    wrong.brushes.roles = brushRoles(*map);
    const BrushReport report = wrong.judge(40000);
    ASSERT_FALSE(report.solid.empty());
    EXPECT_GT(report.rows.misses, 0u);
    for (const RowMiss& miss : report.solid) EXPECT_GT(glm::distance(miss.from, miss.to), 0);
    EXPECT_TRUE(walled.judge(40000).solid.empty());
}

TEST(BrushRays, ConvictATreeWithoutADoor) { judgeWithoutADoor(0); }

// A brush far off once made all brushes grow by 30 units and more: the door was shut.
TEST(BrushRays, ConvictATreeWithoutADoorWhateverLiesFarOff) {
    for (const int stray : {100000, 1000000, 10000000}) {
        SCOPED_TRACE(stray);
        const Result<BrushRays> rays = Judged(roomsText(true, stray)).rays();
        ASSERT_TRUE(rays.ok()) << rays.error().message;
        EXPECT_NEAR(rays->growth(8), 0.02, 1e-6) << "a pillar";
        EXPECT_NEAR(rays->growth(10), 0.02, 1e-3) << "the brush far off";
        judgeWithoutADoor(stray);
    }
}

TEST(BrushRays, ConvictRowsThatLackAPair) {
    const Judged right(roomsText());
    Judged wrong = right;
    size_t tried = 0, found = 0;
    for (uint32_t a = 0; a < right.graph.cells; ++a)
        for (uint32_t b = 0; b < a; ++b) {
            if (!right.visible.at(a, b)) continue;
            wrong.visible = BitMatrix(right.visible.rows(), right.visible.columns());
            for (uint32_t i = 0; i < right.graph.cells; ++i)
                for (uint32_t k = 0; k < right.graph.cells; ++k)
                    if (right.visible.at(i, k) && !(std::max(i, k) == a && std::min(i, k) == b))
                        wrong.visible.set(i, k);
            const BrushReport report = wrong.judge(8000, a);
            ++tried;
            found += report.rows.misses == 2;
        }
    EXPECT_GE(tried, 5u);
    EXPECT_GE(10 * found, 9 * tried);
}

TEST(BrushRays, ReadWhatEditorsWrite) {
    const std::string side = "( 0 0 0 ) ( 0 64 0 ) ( 64 0 0 ) ";
    const struct {
        std::string text;
        size_t brushes;
    } cases[] = {
        {"{\n\"a\" \"{ ( \\\"b\\\" }\"\n{\n" + side + "{grate 0 0 0 1 1\n" + side +
             "a}b 0 0 0 1 1 // } comment\n}\n}\n",
         1},
        {"{ \"a\" \"c:\\x\\\" }\n{\n// brush 0\n{\r\n\t" + side + "+0a(b) [ 1 0 0 0 ] [ 0 1 0 0 ] 0 1 1\r\n}\r\n}\r\n",
         1},
        {"{\n{\nbrushDef\n{\n" + side +
             "( ( 1 0 0 ) ( 0 1 0 ) ) x/y 0 0 0\n}\n}\n{\npatchDef2\n{\nx/y\n( 3 3 0 0 0 )\n(\n( ( 0 0 0 0 0 ) "
             ")\n)\n}\n}\n{\n}\n}\n",
         2},
        {"", 0},
    };
    for (const auto& [text, brushes] : cases) {
        const std::vector<uint8_t> stops(brushes, 1);
        const Result<BrushRays> rays = BrushRays::read(text, stops, 0.01);
        ASSERT_TRUE(rays.ok()) << text << rays.error().message;
        EXPECT_EQ(rays->brushes(), brushes) << text;
        EXPECT_FALSE(BrushRays::read(text, std::vector<uint8_t>(brushes + 1, 1), 0.01).ok());
    }
}

TEST(BrushRaysMaps, FindNothingInRealMaps) {
    const auto files = sharedFiles("maps", ".map");
    if (files.empty()) GTEST_SKIP() << "no maps beside the repository";
    for (const std::filesystem::path& file : files) {
        const std::string name = file.stem().string();
        if (name != "byob_rabbit" && name != "lq_e4m1") continue;
        const Judged map(readBytes(file));
        const BrushReport report = map.judge(60000);
        EXPECT_EQ(report.rows.misses, 0u) << name;
        EXPECT_TRUE(report.solid.empty()) << name;
        EXPECT_GT(report.rows.segments, 10000u) << name;
    }
}

}  // namespace
}  // namespace sightline::test
