// The law of walks: every combination of what they may use keeps one set, and the refinement a part of it that holds the truth.
// SPDX-License-Identifier: MIT
#include "sightline/cull/coherent_frustum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory_resource>

#include "tests/cull/clip_oracle.h"
#include "tests/support_targets.h"

namespace sightline {
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
    HierarchyCulling how;
    how.eight_at_once = false;
    how.inside = bits & 1;
    how.masking = bits & 2;
    how.octant = bits & 4;
    how.plane_coherency = bits & 8;
    how.translation = bits & 16;
    how.rotation = bits & 32;
    return how;
}

TEST(HierarchyWalk, EveryCombinationKeepsOneSet) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        const glm::dvec3 around = seed == 4 ? glm::dvec3(1e5, 0, -1e5) : glm::dvec3(0.0);
        const Bvh bvh = buildBvh(randomBoxes(seed, 1500, around));
        std::vector<std::unique_ptr<HierarchyCuller>> cullers;
        for (int bits = 0; bits < 64; ++bits) cullers.push_back(std::make_unique<HierarchyCuller>());
        std::vector<uint64_t> unmoved(64), tests(64);
        HierarchyCuller eight, changing;
        for (const View& view : cameraPath(seed, around)) {
            RefinedVolume refined;
            refined.volume = volumeOf(makeFrustum(view));
            std::vector<uint32_t> expected(1500), kept;
            expected.resize(eight.cull(refined, bvh, {}, expected));
            std::sort(expected.begin(), expected.end());
            kept.assign(1500, 0);
            kept.resize(changing.cull(refined, bvh, oneByOne(static_cast<int>(mixSeed(seed, tests[0]) % 64)), kept));
            std::sort(kept.begin(), kept.end());
            ASSERT_EQ(kept, expected) << "seed " << seed << ", another combination each frame";
            for (int bits = 0; bits < 64; ++bits) {
                kept.assign(1500, 0);
                kept.resize(cullers[bits]->cull(refined, bvh, oneByOne(bits), kept));
                std::sort(kept.begin(), kept.end());
                ASSERT_EQ(kept, expected) << "seed " << seed << " bits " << bits;
                unmoved[bits] += cullers[bits]->stats().unmoved;
                tests[bits] += cullers[bits]->stats().plane_tests;
            }
        }
        EXPECT_GT(unmoved[16], 0u);
        EXPECT_GT(unmoved[32], 0u);
        EXPECT_GT(unmoved[48], unmoved[16]);
        for (const int bit : {2, 4, 8, 16, 32}) {  // masking asks nothing below what is inside, so 1 adds nothing to it

            EXPECT_LT(tests[63], tests[63 - bit]) << seed << " without " << bit;
        }
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
            const Bvh bvh = buildBvh(boxes);
            HierarchyCuller culler;
            for (const View& view : cameraPath(seed, {0, 0, 0})) {
                const RefinedVolume refined = refineVolume(volumeOf(makeFrustum(view)));
                std::vector<uint32_t> kept(2000), finer(2000);
                kept.resize(culler.cull(refined, bvh, {}, kept));
                all.insert(all.end(), kept.begin(), kept.end());
                HierarchyCulling how;
                how.refinement = Refinement::kSeparatingAxes;
                how.large = 2.0f;
                finer.resize(culler.cull(refined, bvh, how, finer));
                how.eight_at_once = false;
                std::vector<uint32_t> scalar(2000);
                scalar.resize(culler.cull(refined, bvh, how, scalar));
                for (auto* set : {&kept, &finer, &scalar}) std::sort(set->begin(), set->end());
                ASSERT_EQ(finer, scalar) << target;
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
    std::vector<Box3d> boxes = randomBoxes(8, 500, {0, 0, 0});
    Bvh bvh = buildBvh(boxes);
    RefinedVolume refined;
    refined.volume = volumeOf(makeFrustum(cameraPath(8, {0, 0, 0})[0]));
    HierarchyCuller culler, fresh;
    std::vector<uint32_t> kept(500), expected(500);
    culler.cull(refined, bvh, everyCoherency(), kept);
    for (uint32_t i = 0; i < 500; ++i) refit(bvh, i, {boxes[499 - i].min, boxes[499 - i].max});
    culler.forget();
    kept.resize(culler.cull(refined, bvh, everyCoherency(), kept));
    expected.resize(fresh.cull(refined, bvh, oneByOne(0), expected));
    std::sort(kept.begin(), kept.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(kept, expected);
}

TEST(HierarchyWalk, EmptyTreesAndVolumesKeepNothing) {
    HierarchyCuller culler;
    RefinedVolume refined;
    std::vector<uint32_t> kept(10);
    EXPECT_EQ(culler.cull(refined, buildBvh({}), {}, kept), 0u);
    const Bvh bvh = buildBvh(randomBoxes(9, 10, {0, 0, 0}));
    EXPECT_EQ(culler.cull(refined, bvh, {}, kept), 10u);  // a volume without planes holds all
    EXPECT_EQ(culler.cull(refined, bvh, everyCoherency(), kept), 10u);
    refined.volume.empty = true;
    EXPECT_EQ(culler.cull(refined, bvh, {}, kept), 0u);
}

/// Counts allocations.
class Counting : public std::pmr::memory_resource {
public:
    size_t count = 0;

private:
    void* do_allocate(size_t bytes, size_t alignment) override {
        ++count;
        return std::pmr::new_delete_resource()->allocate(bytes, alignment);
    }
    void do_deallocate(void* p, size_t bytes, size_t alignment) override {
        std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

TEST(HierarchyWalk, AllocatesNothingOnceItIsWarm) {
    Counting memory;
    const Bvh bvh = buildBvh(randomBoxes(10, 2000, {0, 0, 0}));
    HierarchyCuller culler(&memory);
    std::vector<uint32_t> kept(2000);
    const std::vector<View> path = cameraPath(10, {0, 0, 0});
    for (int pass = 0; pass < 2; ++pass) {
        const size_t before = memory.count;
        for (const View& view : path) {
            RefinedVolume refined;
            refined.volume = volumeOf(makeFrustum(view));
            culler.cull(refined, bvh, {}, kept);
            culler.cull(refined, bvh, everyCoherency(), kept);
        }
        if (pass) { EXPECT_EQ(memory.count, before); }
    }
}

}  // namespace
}  // namespace sightline
