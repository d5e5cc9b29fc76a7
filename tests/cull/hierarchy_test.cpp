// Frusta over a world's hierarchy: to the bit what a flat list keeps, and of several what a walk for each of them finds.
// SPDX-License-Identifier: MIT
#include "sightline/cull/hierarchy.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sightline/tree/bvh_node.h"
#include "tests/support/targets.h"
#include "tests/tree/living_fixture.h"

namespace sightline::test {
namespace {

constexpr double kWorld = 100.0;

/// Boxes, some of which have moved, gone and come since the tree over them was built.
WorldBvh livedTree(Random& random, uint32_t items) {
    std::vector<Box3d> boxes;
    std::vector<uint32_t> numbers;
    for (uint32_t i = 0; i < items; ++i) {
        boxes.push_back(randomBox(random, randomPoint(random, kWorld), kWorld));
        numbers.push_back(i);
    }
    WorldBvh tree;
    tree.build(boxes, numbers);
    for (uint32_t i = 0; i + 1 < items; i += 5) {
        const glm::dvec3 by = randomPoint(random, 5);
        if (i % 3) tree.move(i, {boxes[i].min + by, boxes[i].max + by});
        else tree.remove(i);
    }
    for (uint32_t i = 0; i + 1 < items; i += 30) {
        const Box3d box = randomBox(random, randomPoint(random, kWorld), kWorld);
        if (tree.insert(i, box) == WorldBvh::kNone) tree.append({&box, 1}, {&i, 1});
    }
    return tree;
}

std::vector<uint32_t> keptByTree(const Frustum& frustum, const PlacedBvh& tree, HierarchyStats* stats = nullptr) {
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(tree.size() + 8);
    kept.resize(cullHierarchy(frustum, tree, scratch, kept, stats));
    std::sort(kept.begin(), kept.end());
    return kept;
}

void expectEqualsFlat(const Frustum& frustum, const PlacedBvh& tree, const std::string& what) {
    std::vector<uint32_t> items;
    std::vector<Box3f> stored;
    for (uint32_t item = 0; item < tree.slot.size(); ++item) {
        const uint32_t at = tree.slot[item];
        if (at == PlacedBvh::kNone) continue;
        items.push_back(item);
        stored.push_back(slotBox(tree.nodes[at / 8], static_cast<int>(at % 8)));
    }
    EXPECT_EQ(tree.size(), items.size());
    EXPECT_EQ(tree.reach(), reachOf(stored));
    std::vector<uint32_t> flat;
    for (const uint32_t which : keptByFlat(frustum, stored, tree.origin, tree.reach())) flat.push_back(items[which]);
    EXPECT_EQ(keptByTree(frustum, tree), flat) << what;
}

TEST(Hierarchy, EqualsAFlatList) {
    Random random(32);
    for (int round = 0; round < 40; ++round) {
        const WorldBvh tree = livedTree(random, static_cast<uint32_t>(random.below(round % 10 == 0 ? 10 : 4000)));
        for (int view = 0; view < 4; ++view) {
            Frustum frustum = makeFrustum(randomView(random, kWorld));
            if (round % 9 == 0 && view == 0) frustum.count = 0;  // without planes: all is inside
            const std::string what = "round " + std::to_string(round) + " view " + std::to_string(view) + " ";
            forEachTarget([&](const std::string& target) { expectEqualsFlat(frustum, tree.now(), what + target); });
        }
        if (HasFailure()) return;
    }
}

TEST(Hierarchy, CopiesWhatIsInsideAndAsksLittleOfTheRest) {
    Random random(33);
    const WorldBvh tree = livedTree(random, 20000);
    HierarchyStats all, some;
    EXPECT_EQ(keptByTree(Frustum(), tree.now(), &all).size(), tree.size());
    EXPECT_EQ(all.nodes, 1u);
    EXPECT_EQ(all.plane_tests, 0u);
    View view;
    view.view = lookAt(glm::dvec3(0.0), glm::dvec3(1, 0.1, 0.3), {0, 1, 0});
    view.projection = perspective(0.5, 1.0, 0.1, 0.3 * kWorld);
    EXPECT_GT(keptByTree(makeFrustum(view), tree.now(), &some).size(), 0u);
    EXPECT_LT(some.nodes, tree.now().nodes.size() / 4);
}

/// The walk for all against the walk for each; returns how many items were kept by some and not by others.
size_t expectEqual(const std::vector<Frustum>& frusta, const PlacedBvh& tree, const std::string& what) {
    HierarchyScratch scratch;
    HierarchyStats many, one;
    uint64_t nodes = 0, plane_tests = 0;
    std::vector<uint32_t> kept(tree.size() + 8), masks(tree.size() + 8), of;
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
        std::sort(of.begin(), of.end());
        EXPECT_EQ(of, keptByTree(frusta[f], tree, &one)) << what << " frustum " << f;
        nodes += one.nodes;
        plane_tests += one.plane_tests;
    }
    EXPECT_EQ(many.plane_tests, plane_tests) << what << ": each frustum asks what it would ask alone";
    EXPECT_LE(many.nodes, nodes) << what;
    return mixed;
}

TEST(HierarchyMany, EqualsAWalkForEach) {
    Random random(31);
    size_t mixed = 0;
    for (int round = 0; round < 60; ++round) {
        const WorldBvh tree = livedTree(random, static_cast<uint32_t>(random.below(round % 10 == 0 ? 10 : 3000)));
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

TEST(HierarchyMany, OfAnEmptyTreeKeepsNothing) {
    EXPECT_EQ(expectEqual(std::vector<Frustum>(32), WorldBvh().now(), "never built"), 0u);
    WorldBvh left;
    const Box3d box{glm::dvec3(0.0), glm::dvec3(1.0)};
    const uint32_t item = 0;
    left.build({&box, 1}, {&item, 1});
    left.remove(item);
    EXPECT_EQ(expectEqual(std::vector<Frustum>(32), left.now(), "all have left"), 0u);
}

}  // namespace
}  // namespace sightline::test
