// Trees of brushes: every point is what the brushes that hold it are.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_tree.h"

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

LeafContents contentsAt(const LeafTree& tree, const glm::dvec3& point) {
    uint32_t child = tree.nodes.empty() ? LeafTreeNode::kLeaf : 0;
    while ((child & LeafTreeNode::kLeaf) == 0)
        child = tree.nodes[child].child[glm::dot(tree.nodes[child].plane, glm::dvec4(point, 1)) >= 0];
    return tree.contents[child & ~LeafTreeNode::kLeaf];
}

/// Against the brushes one by one; points closer than `least` to a side are not asked.
void expectContents(const QuakeMap& map, const BrushTree& brushes, double least, uint64_t seed, int count) {
    Random random(seed);
    const Box3d& bounds = brushes.tree.bounds;
    const std::vector<BrushRole> roles = brushRoles(map).roles;
    uint64_t asked = 0, solid = 0;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 point =
            bounds.min + glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * bounds.size();
        LeafContents expected = LeafContents::kEmpty;
        bool near = false;
        for (const QuakeMapEntity& entity : map.entities)
            for (const QuakeMapBrush& brush : map.brushesOf(entity)) {
                const BrushRole role = roles[static_cast<size_t>(&brush - map.brushes.data())];
                if (role >= BrushRole::kUnknown) continue;
                const double depth = depthIn(map, brush, point);
                near |= std::abs(depth) < least;
                if (depth <= 0) continue;
                expected = std::max(expected, role == BrushRole::kSolid ? LeafContents::kSolid
                                              : role == BrushRole::kSky ? LeafContents::kSky
                                                                        : LeafContents::kLiquid);
            }
        if (near) continue;
        ASSERT_EQ(contentsAt(brushes.tree, point), expected)
            << "seed " << seed << " at " << point.x << " " << point.y << " " << point.z;
        ++asked;
        solid += expected == LeafContents::kSolid;
    }
    EXPECT_GT(asked, uint64_t(count) / 2);
    EXPECT_GT(solid, 0u);
}

glm::dmat3 randomTurn(Random& random) {
    const glm::dvec3 axis =
        glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), random.uniform(0, 3), axis));
}

TEST(BrushTree, HoldsWhatBrushesHold) {
    const char* const textures[] = {"brick", "brick", "*water", "sky1"};
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        Random random(seed);
        BrushMaker maker;
        for (uint64_t i = 0; i < 10 + 20 * (seed % 3); ++i) {
            glm::dvec3 low, size;
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = static_cast<double>(random.below(32)) * 16 - 256;
                size[axis] = static_cast<double>(1 + random.below(16)) * 16;
            }
            const char* texture = textures[random.below(4)];
            if (random.below(3) == 0) {
                maker.box(low, low + size, texture, randomTurn(random));
            } else if (random.below(3) == 0) {
                // Round a point, with any number of sides.
                std::vector<glm::dvec4> planes;
                for (uint64_t k = 5 + random.below(12); k > 0; --k) {
                    const glm::dvec3 n = randomTurn(random)[0];
                    planes.emplace_back(n, -glm::dot(n, low) - random.uniform(20, 90));
                }
                maker.brush(planes, texture);
            } else {
                maker.box(low, low + size, texture);
            }
        }
        const BrushTree brushes = treeOfBrushes(maker.map, {.snap_distance = 1e-6, .block = seed % 2 ? 1024.0 : 128.0});
        expectContents(maker.map, brushes, 1e-4, seed, 3000);
    }
}

TEST(BrushTree, LeavesOutWhatHidesNothing) {
    BrushMaker maker;
    maker.box({0, 0, 0}, {64, 64, 64});
    maker.box({100, 0, 0}, {164, 64, 64}, "clip");
    maker.box({200, 0, 0}, {164, 64, 64});  // inside out: holds nothing
    maker.entity({{"classname", "func_detail"}});
    maker.box({0, 100, 0}, {64, 164, 64});
    maker.entity({{"classname", "func_door"}});
    maker.box({0, 200, 0}, {64, 264, 64});
    maker.entity({{"classname", "func_group"}});
    maker.box({0, 300, 0}, {64, 364, 64});
    const BrushTree brushes = treeOfBrushes(maker.map);
    EXPECT_EQ(brushes.counts.solid, 3u);
    EXPECT_EQ(brushes.counts.nothing, 2u);
    EXPECT_EQ(brushes.counts.empty, 1u);
    EXPECT_EQ(contentsAt(brushes.tree, {32, 32, 32}), LeafContents::kSolid);
    EXPECT_EQ(contentsAt(brushes.tree, {132, 32, 32}), LeafContents::kEmpty);
    EXPECT_EQ(contentsAt(brushes.tree, {32, 132, 32}), LeafContents::kEmpty);
    EXPECT_EQ(contentsAt(brushes.tree, {32, 232, 32}), LeafContents::kEmpty);
    EXPECT_EQ(contentsAt(brushes.tree, {32, 332, 32}), LeafContents::kSolid);
    EXPECT_EQ(brushes.tree.bounds.min, glm::dvec3(-24));
    EXPECT_EQ(brushes.edge_leaves.size(), brushes.edge_points.size());
    EXPECT_GT(brushes.edge_leaves.size(), 0u);
}

TEST(BrushTree, MakesPlanesThatAreAllButOneOne) {
    for (const double gap : {0.005, 0.05}) {
        BrushMaker maker;
        maker.box({0, 0, 0}, {64, 64, 64});
        maker.box({64 + gap, 0, 0}, {128, 64, 64});
        const BrushTree brushes = treeOfBrushes(maker.map);
        EXPECT_EQ(contentsAt(brushes.tree, {64 + 0.5 * gap, 32, 32}),
                  gap < 0.01 ? LeafContents::kSolid : LeafContents::kEmpty);
    }
}

/// A box that ends at x = 0, and a brush whose face leans away from it by 9e-6 of y, so that a wedge is open between them.
BrushTree leaningBrushes(double low_y, double high_y) {
    BrushMaker maker;
    maker.box({-64, low_y, -64}, {0, high_y, 64});
    const glm::dvec3 leaning = glm::normalize(glm::dvec3(-1, 9e-6, 0));
    maker.brush({glm::dvec4(leaning, 0), glm::dvec4(1, 0, 0, -64), glm::dvec4(0, -1, 0, low_y),
                 glm::dvec4(0, 1, 0, -high_y), glm::dvec4(0, 0, -1, -64), glm::dvec4(0, 0, 1, -64)});
    return treeOfBrushes(maker.map);
}

TEST(BrushTree, MeasuresPlanesThatAreAllButOneAtTheBrushes) {
    // The wedge is 0.9 wide far off, where the planes part, and 0.0009 near the origin.
    const BrushTree far = leaningBrushes(99900, 100000), near = leaningBrushes(0, 100);
    EXPECT_EQ(contentsAt(far.tree, {0.45, 99950, 0.5}), LeafContents::kEmpty);
    EXPECT_EQ(contentsAt(far.tree, {-1, 99950, 0.5}), LeafContents::kSolid);
    EXPECT_EQ(contentsAt(far.tree, {1, 99950, 0.5}), LeafContents::kSolid);
    EXPECT_EQ(contentsAt(near.tree, {0.0004, 90, 0.5}), LeafContents::kSolid);
    // No other brush is needed to move a face: it may be taken for one along an axis.
    BrushMaker alone;
    alone.brush({glm::dvec4(glm::normalize(glm::dvec3(-1, 9e-6, 0)), 0), glm::dvec4(1, 0, 0, -64),
                 glm::dvec4(0, -1, 0, 99900), glm::dvec4(0, 1, 0, -100000), glm::dvec4(0, 0, -1, -64),
                 glm::dvec4(0, 0, 1, -64)});
    EXPECT_EQ(contentsAt(treeOfBrushes(alone.map).tree, {0.45, 99950, 0.5}), LeafContents::kEmpty);
    // Two grids, far off.
    BrushMaker grids;
    grids.box({1e5, 0, 0}, {1e5 + 64, 64, 64});
    grids.box({1e5 + 64.005, 0, 0}, {1e5 + 128, 64, 64});
    EXPECT_EQ(contentsAt(treeOfBrushes(grids.map).tree, {1e5 + 64.0025, 32, 32}), LeafContents::kSolid);
}

TEST(BrushTree, KeepsSlitsOpenWhateverLiesFarOff) {
    constexpr double kSlit = 0.012;
    for (const double far : {1e5, 1e7, 9e8}) {
        SCOPED_TRACE(far);
        BrushMaker maker;
        maker.box({-64, -64, -64}, {0, 64, 64});
        maker.box({kSlit, -64, -64}, {64, 64, 64});
        maker.box({far, -64, -64}, {far + 64, 64, 64});
        const BrushTree brushes = treeOfBrushes(maker.map);
        for (const double y : {-60.0, 0.5, 60.0})
            EXPECT_EQ(contentsAt(brushes.tree, {0.5 * kSlit, y, 0.5}), LeafContents::kEmpty) << y;
        EXPECT_EQ(contentsAt(brushes.tree, {-32, 0.5, 0.5}), LeafContents::kSolid);
        EXPECT_EQ(contentsAt(brushes.tree, {32, 0.5, 0.5}), LeafContents::kSolid);
        // A brush that is as wide as all fills no more.
        BrushMaker ground;
        ground.box({-far, -64, -far}, {far, 0, far});
        ground.box({-64, kSlit, -64}, {64, 64, 64});
        const BrushTree above = treeOfBrushes(ground.map);
        EXPECT_EQ(contentsAt(above.tree, {0.5, 0.5 * kSlit, 0.5}), LeafContents::kEmpty);
        EXPECT_EQ(contentsAt(above.tree, {0.5, -32, 0.5}), LeafContents::kSolid);
        EXPECT_EQ(contentsAt(above.tree, {0.5, 32, 0.5}), LeafContents::kSolid);
    }
}

TEST(BrushTree, StandsMapsOfNothingAndOfEverything) {
    BrushMaker none;
    EXPECT_EQ(treeOfBrushes(none.map).tree.contents, std::vector<LeafContents>{LeafContents::kEmpty});
    BrushMaker endless;
    endless.brush({glm::dvec4(1, 0, 0, -8)});
    endless.brush({glm::dvec4(0, 1, 0, -8), glm::dvec4(0, -1, 0, 0), glm::dvec4(1, 0, 0, 0), glm::dvec4(-1, 0, 0, -8)});
    endless.box({-100, -100, -100}, {-50, -50, -50});
    const BrushTree brushes = treeOfBrushes(endless.map);
    EXPECT_EQ(brushes.counts.solid, 3u);
    EXPECT_EQ(contentsAt(brushes.tree, {-75, -75, -75}), LeafContents::kSolid);
    BrushMaker far;
    far.box({-1e9, -1e9, -1e9}, {1e9, -1e8, 1e9});
    far.box({0, 0, 0}, {16, 16, 16});
    EXPECT_EQ(contentsAt(treeOfBrushes(far.map).tree, {8, 8, 8}), LeafContents::kSolid);
}

TEST(BrushTree, LeavesOutWhatEditorsAndCompilersLeaveOut) {
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    BrushMaker maker;
    const auto isLeftOut = [&](const Pairs& pairs) {
        maker.entity(pairs);
        maker.box({0, 0, 0}, {1, 1, 1}, "wall");
        return roleOf(maker.map, maker.map.brushes.back()) == BrushRole::kNothing;
    };
    const auto layer = [](const char* id, const char* omit) {
        return Pairs{{"classname", "func_group"},
                     {"_tb_type", "_tb_layer"},
                     {"_tb_id", id},
                     {"_tb_layer_omit_from_export", omit}};
    };
    EXPECT_TRUE(isLeftOut(layer("1", "1")));
    EXPECT_FALSE(isLeftOut(layer("2", "0")));
    EXPECT_TRUE(
        isLeftOut({{"classname", "func_group"}, {"_tb_type", "_tb_group"}, {"_tb_id", "3"}, {"_tb_layer", "1"}}));
    EXPECT_FALSE(
        isLeftOut({{"classname", "func_group"}, {"_tb_type", "_tb_group"}, {"_tb_id", "4"}, {"_tb_layer", "2"}}));
    EXPECT_TRUE(
        isLeftOut({{"classname", "func_group"}, {"_tb_type", "_tb_group"}, {"_tb_id", "5"}, {"_tb_group", "3"}}));
    EXPECT_TRUE(isLeftOut({{"classname", "func_group"}, {"_tb_group", "5"}}));
    EXPECT_FALSE(isLeftOut({{"classname", "func_group"}, {"_tb_group", "4"}}));
    EXPECT_FALSE(isLeftOut({{"classname", "func_group"}, {"_tb_group", "9"}, {"_tb_layer", "9"}}));
    EXPECT_TRUE(isLeftOut({{"classname", "func_group"}, {"_omitbrushes", "1"}}));
    EXPECT_FALSE(isLeftOut({{"classname", "func_group"}, {"_omitbrushes", "0"}}));
    // A group in itself is no reason to hang.
    EXPECT_FALSE(
        isLeftOut({{"classname", "func_group"}, {"_tb_type", "_tb_group"}, {"_tb_id", "7"}, {"_tb_group", "7"}}));
}

TEST(BrushTreeMaps, HoldWhatBrushesHold) {
    const std::filesystem::path folder = SIGHTLINE_SHARED_DIR "/maps";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared maps are not there: " << folder;
    for (const char* name : {"lq_e2m2", "lqdm3"}) {
        const Result<std::string> text = readTextFile((folder / name).string() + ".map");
        ASSERT_TRUE(text.ok());
        const Result<QuakeMap> map =
            parseQuakeMap({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, name);
        ASSERT_TRUE(map.ok()) << map.error().message;
        expectContents(*map, treeOfBrushes(*map), 0.1, 1, 500);
    }
}

}  // namespace
}  // namespace sightline::test
