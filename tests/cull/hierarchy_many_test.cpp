// Several frusta in one walk of a living hierarchy: to the bit what a walk for each of them finds.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "sightline/cull/hierarchy.h"
#include "tests/space/living_fixture.h"
#include "tests/support_targets.h"

namespace sightline::test {
namespace {

constexpr double kWorld = 100.0;

/// The walk for all against the walk for each; returns how many items were kept by some and not by others.
size_t expectEqual(const std::vector<Frustum>& frusta, const LivingBvh& tree, const std::string& what) {
    HierarchyScratch scratch;
    HierarchyStats many, one, sum;
    std::vector<uint32_t> kept(tree.count + 8), masks(tree.count + 8), single(tree.count + 8), of;
    const size_t count = cullHierarchy(frusta, tree, scratch, kept, masks, &many);
    size_t mixed = 0;
    for (size_t i = 0; i < count; ++i) {
        EXPECT_NE(masks[i], 0u) << what;
        EXPECT_EQ(uint64_t{masks[i]} >> frusta.size(), 0u) << what;
        mixed += masks[i] != uint32_t((uint64_t{1} << frusta.size()) - 1);
    }
    for (size_t f = 0; f < frusta.size(); ++f) {
        of.clear();
        for (size_t i = 0; i < count; ++i)
            if (masks[i] >> f & 1) of.push_back(kept[i]);
        single.resize(tree.count + 8);
        single.resize(cullHierarchy(frusta[f], tree, scratch, single, &one));
        EXPECT_EQ(of, single) << what << " frustum " << f;
        sum.nodes += one.nodes;
        sum.plane_tests += one.plane_tests;
    }
    EXPECT_EQ(many.plane_tests, sum.plane_tests) << what << ": each frustum asks what it would ask alone";
    EXPECT_LE(many.nodes, sum.nodes) << what;
    return mixed;
}

TEST(HierarchyMany, EqualsAWalkForEach) {
    Random random(31);
    size_t mixed = 0;
    for (int round = 0; round < 60; ++round) {
        DynamicBvh tree;
        std::vector<Box3d> boxes;
        const uint32_t items = static_cast<uint32_t>(random.below(round % 10 == 0 ? 10 : 3000));
        for (uint32_t i = 0; i < items; ++i) boxes.push_back(randomBox(random, randomPoint(random, kWorld), kWorld));
        for (uint32_t i = 0; i < items; i += 97) boxes[i].min.x = std::numeric_limits<double>::quiet_NaN();
        tree.build(boxes);
        for (uint32_t i = 0; i + 1 < items; i += 5) {
            const glm::dvec3 by = randomPoint(random, 5);
            if (i % 3) tree.move(i, {boxes[i].min + by, boxes[i].max + by});
            else tree.remove(i);
        }
        if (round % 2) tree.update();
        const size_t counts[] = {1, 2, 4, 6, 9, 32};
        std::vector<Frustum> frusta;
        for (size_t i = 0; i < counts[random.below(6)]; ++i) frusta.push_back(makeFrustum(randomView(random, kWorld)));
        if (round % 4 == 0) frusta.push_back(frusta[0]);  // one twice
        if (frusta.size() > 32) frusta.resize(32);
        if (round % 7 == 0) frusta[0].count = 0;  // without planes: all is inside
        const std::string what = "round " + std::to_string(round);
        forEachTarget(
            [&](const std::string& target) { mixed += expectEqual(frusta, tree.now(), what + " " + target); });
        if (HasFailure()) return;
    }
    EXPECT_GT(mixed, 10000u);
}

TEST(HierarchyMany, OfAnEmptyTreeKeepsWhatIsUnbounded) {
    DynamicBvh tree;
    std::vector<Frustum> frusta(32);
    EXPECT_EQ(expectEqual(frusta, tree.now(), "empty"), 0u);
    tree.insert({glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(0.0)});
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(9), masks(9);
    ASSERT_EQ(cullHierarchy(frusta, tree.now(), scratch, kept, masks), 1u);
    EXPECT_EQ(masks[0], ~0u);
}

}  // namespace
}  // namespace sightline::test
