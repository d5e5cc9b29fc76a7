// The law of walks: every combination of what they may use keeps one set, and the refinement a part of it that holds the truth.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/coherent_frustum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/studies/frustum/clip_oracle.h"
#include "tests/support/memory.h"
#include "tests/support/targets.h"

namespace sightline {
using namespace studies;
namespace {

std::vector<Box3d> randomBoxes(uint64_t seed, size_t count, const glm::dvec3& around) {
    Random random(seed);
    std::vector<Box3d> boxes;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 p =
            around + glm::dvec3(random.uniform(-50, 50), random.uniform(-10, 10), random.uniform(-50, 50));
        const double size = i % 50 ? 1.0 : 40.0;
        boxes.push_back({p, p + size * glm::dvec3(random.uniform(), random.uniform(), random.uniform())});
    }
    return boxes;
}

WorldBvh treeOver(const std::vector<Box3d>& boxes) {
    std::vector<uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0u);
    WorldBvh tree;
    tree.build(boxes, items);
    return tree;
}

/// What is kept, in rising order.
std::vector<uint32_t> cull(HierarchyCuller& culler, const RefinedVolume& refined, const WorldBvh& tree,
                           const HierarchyCulling& how) {
    std::vector<uint32_t> kept(tree.size() + 8);
    kept.resize(culler.cull(refined, tree.now(), how, kept));
    std::sort(kept.begin(), kept.end());
    return kept;
}

/// A camera that stands, moves, turns, does both, zooms, and jumps.
std::vector<View> cameraPath(uint64_t seed, const glm::dvec3& around) {
    Random random(seed);
    std::vector<View> path;
    glm::dvec3 eye = around, ahead = test::randomUnit(random);
    double angle = 1.0;
    for (int frame = 0; frame < 60; ++frame) {
        if (frame / 10 == 1 || frame / 10 == 3) eye += 1.0 * test::randomUnit(random);
        if (frame / 10 == 2 || frame / 10 == 3) ahead = glm::normalize(ahead + 0.05 * test::randomUnit(random));
        if (frame / 10 == 4) angle = random.uniform(0.5, 1.5);
        if (frame == 50) eye = around + 30.0 * test::randomUnit(random);
        View view;
        view.view = lookAt(eye, eye + ahead, {0, 1, 0});
        view.projection =
            seed % 4 == 1 ? orthographic(20, 1.3, 0.1, 60) : perspective(angle, 1.3, 0.1, seed % 2 ? INFINITY : 60.0);
        if (seed % 4 == 2) view.projection[2][0] = 0.4;
        path.push_back(view);
    }
    return path;
}

HierarchyCulling oneByOne(int bits) {
    return {.eight_at_once = false,
            .inside = (bits & 1) != 0,
            .masking = (bits & 2) != 0,
            .octant = (bits & 4) != 0,
            .plane_coherency = (bits & 8) != 0,
            .translation = (bits & 16) != 0,
            .rotation = (bits & 32) != 0};
}

TEST(HierarchyWalk, EveryCombinationKeepsOneSet) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        const glm::dvec3 around = seed == 4 ? glm::dvec3(1e5, 0, -1e5) : glm::dvec3(0.0);
        const WorldBvh tree = treeOver(randomBoxes(seed, 1500, around));
        std::vector<std::unique_ptr<HierarchyCuller>> cullers;
        for (int bits = 0; bits < 64; ++bits) cullers.push_back(std::make_unique<HierarchyCuller>());
        std::vector<uint64_t> unmoved(64), tests(64);
        HierarchyCuller eight, changing;
        for (const View& view : cameraPath(seed, around)) {
            RefinedVolume refined;
            refined.volume = volumeOf(makeFrustum(view));
            const std::vector<uint32_t> expected = cull(eight, refined, tree, {});
            ASSERT_EQ(cull(changing, refined, tree, oneByOne(static_cast<int>(mixSeed(seed, tests[0]) % 64))), expected)
                << "seed " << seed << ", another combination each frame";
            for (int bits = 0; bits < 64; ++bits) {
                ASSERT_EQ(cull(*cullers[bits], refined, tree, oneByOne(bits)), expected)
                    << "seed " << seed << " bits " << bits;
                unmoved[bits] += cullers[bits]->stats().unmoved;
                tests[bits] += cullers[bits]->stats().plane_tests;
            }
        }
        EXPECT_GT(unmoved[16], 0u);
        EXPECT_GT(unmoved[32], 0u);
        EXPECT_GT(unmoved[48], unmoved[16]);
        // Masking asks nothing below what is inside, so 1 adds nothing to it; where the others are on, 8 has next to
        // nothing left to save.
        for (const int bit : {2, 4, 16, 32}) EXPECT_LT(tests[63], tests[63 - bit]) << seed << " without " << bit;
        EXPECT_LT(static_cast<double>(tests[63]), 1.01 * static_cast<double>(tests[63 - 8])) << seed;
        EXPECT_LT(tests[4], tests[0]);
        EXPECT_LT(tests[8], tests[0]);
    }
}

TEST(HierarchyWalk, KeepsWhatTheBoxesOneByOneKeepOnEveryInstructionSet) {
    std::vector<uint32_t> first;
    test::forEachTarget([&](const std::string& target) {
        std::vector<uint32_t> all;
        for (const uint64_t seed : {5, 6, 7}) {
            const std::vector<Box3d> boxes = randomBoxes(seed, 2000, {0, 0, 0});
            const WorldBvh tree = treeOver(boxes);
            HierarchyCuller culler;
            for (const View& view : cameraPath(seed, {0, 0, 0})) {
                const RefinedVolume refined = refineVolume(volumeOf(makeFrustum(view)));
                std::vector<uint32_t> kept(2008);
                kept.resize(culler.cull(refined, tree.now(), {}, kept));
                all.insert(all.end(), kept.begin(), kept.end());
                std::sort(kept.begin(), kept.end());
                HierarchyCulling how{.refinement = Refinement::kSeparatingAxes, .large = 2.0f};
                const std::vector<uint32_t> finer = cull(culler, refined, tree, how);
                how.eight_at_once = false;
                ASSERT_EQ(finer, cull(culler, refined, tree, how)) << target;
                ASSERT_TRUE(std::includes(kept.begin(), kept.end(), finer.begin(), finer.end())) << target;
                for (uint32_t i = 0; i < boxes.size(); ++i) {
                    if (testBound(refined.volume, boxes[i]).outside) continue;
                    ASSERT_TRUE(std::binary_search(kept.begin(), kept.end(), i)) << target << " box " << i;
                    if (separated(refined, boxes[i], Refinement::kSeparatingAxes)) continue;
                    ASSERT_TRUE(std::binary_search(finer.begin(), finer.end(), i)) << target << " box " << i;
                }
                ViewVolume wider = refined.volume;
                for (uint32_t k = 0; k < wider.count; ++k) wider.planes[k].w += 0.01;
                for (const uint32_t i : kept)
                    ASSERT_FALSE(testBound(wider, boxes[i]).outside) << target << " box " << i;
            }
        }
        if (first.empty()) first = all;
        ASSERT_EQ(all, first) << target;
    });
}

TEST(HierarchyWalk, ForgetsWhenToldSo) {
    const std::vector<Box3d> boxes = randomBoxes(8, 500, {0, 0, 0});
    WorldBvh tree = treeOver(boxes);
    RefinedVolume refined;
    refined.volume = volumeOf(makeFrustum(cameraPath(8, {0, 0, 0})[0]));
    HierarchyCuller culler, fresh, stale;
    cull(culler, refined, tree, everyCoherency());
    cull(stale, refined, tree, everyCoherency());
    Random random(8);
    for (uint32_t i = 0; i < 500; ++i) {
        const glm::dvec3 by = 3.0 * test::randomUnit(random);
        tree.move(i, {boxes[i].min + by, boxes[i].max + by});
    }
    culler.forget();
    const std::vector<uint32_t> expected = cull(fresh, refined, tree, oneByOne(0));
    EXPECT_EQ(cull(culler, refined, tree, everyCoherency()), expected);
    EXPECT_NE(cull(stale, refined, tree, everyCoherency()), expected);  // else nothing was tested
}

TEST(HierarchyWalk, PlacesThatAreEmptyKeepNothing) {
    WorldBvh tree = treeOver(randomBoxes(11, 1000, {0, 0, 0}));
    std::vector<uint32_t> left;
    for (uint32_t i = 0; i < 1000; ++i)
        if (i % 3) left.push_back(i);
        else tree.remove(i);
    HierarchyCuller culler;
    EXPECT_EQ(cull(culler, {}, tree, {}), left);
    EXPECT_EQ(cull(culler, {}, tree, oneByOne(63)), left);
}

TEST(HierarchyWalk, EmptyTreesAndVolumesKeepNothing) {
    HierarchyCuller culler;
    RefinedVolume refined;
    EXPECT_TRUE(cull(culler, refined, WorldBvh(), {}).empty());
    const WorldBvh tree = treeOver(randomBoxes(9, 10, {0, 0, 0}));
    EXPECT_EQ(cull(culler, refined, tree, {}).size(), 10u);  // a volume without planes holds all
    EXPECT_EQ(cull(culler, refined, tree, everyCoherency()).size(), 10u);
    refined.volume.empty = true;
    EXPECT_TRUE(cull(culler, refined, tree, {}).empty());
}

TEST(HierarchyWalk, AllocatesNothingOnceItIsWarm) {
    test::CountingMemory memory;
    const WorldBvh tree = treeOver(randomBoxes(10, 2000, {0, 0, 0}));
    HierarchyCuller culler(&memory);
    std::vector<uint32_t> kept(2008);
    const std::vector<View> path = cameraPath(10, {0, 0, 0});
    for (int pass = 0; pass < 2; ++pass) {
        const size_t before = memory.allocations;
        for (const View& view : path) {
            RefinedVolume refined;
            refined.volume = volumeOf(makeFrustum(view));
            culler.cull(refined, tree.now(), {}, kept);
            culler.cull(refined, tree.now(), everyCoherency(), kept);
        }
        if (pass) { EXPECT_EQ(memory.allocations, before); }
    }
}

}  // namespace
}  // namespace sightline
