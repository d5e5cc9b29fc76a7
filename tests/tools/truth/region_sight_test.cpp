// Rays from a box see what stands open before it, through glass and past backs, and nothing behind a wall.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/region_sight.h"

#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/thread_pool.h"
#include "sightline/tools/scene/solids.h"

namespace sightline {
using namespace tools;
namespace {

/// A square in the plane x = 0 whose front faces -x, as object 0; a box behind it, object 1; and one before it, object 2.
struct Squared {
    Squared(bool glass, bool turned) {
        scene.materials.resize(2);
        scene.materials[1].alpha_mode = glass ? AlphaMode::kBlend : AlphaMode::kOpaque;
        city::MeshBuilder square, box;
        const glm::dvec3 a(0, -8, -8), b(0, -8, 8), c(0, 8, 8), d(0, 8, -8);
        if (turned) square.quad(1, a, d, c, b);
        else square.quad(1, a, b, c, d);
        city::addBox(box, 0, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
        scene.meshes = {square.finish("square"), box.finish("box")};
        scene.objects.resize(3);
        for (const uint32_t object : {1u, 2u}) {
            scene.objects[object].mesh = 1;
            scene.objects[object].transform[3].x = object == 1 ? 2 : -4;
        }
    }
    std::vector<uint8_t> seen(uint32_t around, uint32_t at_object) const {
        std::vector<uint8_t> out(3, 0);
        Random random(1);
        const std::vector<uint32_t> all{0, 1, 2};
        RegionSight(scene).look({{-3, -1, -1}, {-2, 1, 1}}, all, {around, at_object}, random, out);
        return out;
    }

    Scene scene;
};

using Seen = std::vector<uint8_t>;

TEST(RegionSight, EndsAtAWallAndPassesGlassAndBacks) {
    for (const auto& [around, at_object] : {std::pair{2000u, 0u}, std::pair{0u, 200u}}) {
        EXPECT_EQ(Squared(false, false).seen(around, at_object), Seen({1, 0, 1}));
        EXPECT_EQ(Squared(true, false).seen(around, at_object), Seen({1, 1, 1})) << "glass is seen, and hides nothing";
        EXPECT_EQ(Squared(false, true).seen(around, at_object), Seen({0, 1, 1})) << "a back is not there";
    }
    EXPECT_EQ(Squared(false, false).seen(0, 0), Seen({0, 0, 0}));
}

TEST(RegionSight, OfRowsFindsWhatTheyHoldAndIsTheSameWithAnyThreads) {
    const Squared made(false, false);
    LeafTree tree;  // leaf 1: x < -1; leaf 2: beyond
    tree.nodes = {{{1, 0, 0, 1}, {LeafTreeNode::kLeaf | 1, LeafTreeNode::kLeaf | 2}}};
    tree.contents.assign(3, LeafContents::kEmpty);
    tree.bounds = {{-6, -2, -2}, {4, 2, 2}};
    const std::vector<uint32_t> object_of{2, 1, 0};
    BitMatrix rows(3, 3);
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 3; ++column) rows.set(row, column);
    rows.clear(1, 0);
    RowRaysSettings settings;
    settings.rays = 4000;
    const BitMatrix seen = seenOfRows(made.scene, tree, object_of, rows, settings);
    EXPECT_FALSE(seen.at(1, 0)) << "the row does not hold it";
    EXPECT_FALSE(seen.at(1, 1)) << "a wall hides it";
    EXPECT_TRUE(seen.at(1, 2));
    EXPECT_TRUE(seen.at(2, 0)) << "past the back of the wall";
    EXPECT_TRUE(seen.at(2, 1));
    EXPECT_EQ(seen.row(0)[0], 0u) << "leaf 0 has no place";
    ThreadPool threads(3);
    settings.jobs = &threads;
    EXPECT_EQ(seenOfRows(made.scene, tree, object_of, rows, settings), seen);
    settings.stop = [] { return true; };
    EXPECT_EQ(seenOfRows(made.scene, tree, object_of, rows, settings).count(), 0u);
}

}  // namespace
}  // namespace sightline
