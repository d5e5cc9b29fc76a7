// The witness of rays: what stands free is seen, what is hidden is not, and a gap far narrower than a pixel is found.
// SPDX-License-Identifier: MIT
#include "bench/box_witness.h"
#include "tests/bench/panel.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace sightline::bench {
namespace {

std::vector<uint32_t> allBoxes(const OcclusionScene& scene) {
    std::vector<uint32_t> all(scene.boxes.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

size_t seenOf(const BoxVerdict& verdict) {
    return static_cast<size_t>(
        std::count_if(verdict.boxes.begin(), verdict.boxes.end(), [](const auto& row) { return row.seen; }));
}

TEST(BoxWitness, SeesWhatStandsBeforeBesideAndAtThePanel) {
    const OcclusionScene scene = onePanel({
        cube(0, 0, 8, 0.5f),       // before
        cube(0, 0, 15, 1),         // behind
        cube(4, 0, 15, 0.5f),      // behind, and beside
        cube(2.6f, 0, 15, 0.5f),   // behind; a part of it is beside
        cube(2.35f, 0, 15, 0.5f),  // behind, just not beside: at the front of the box it ends at x = 2.9
        cube(0, 0, 10.5f, 0.5f),   // its front lies in the panel's plane
        cube(0, 0, -15, 1),        // behind the eye
    });
    const View view = occlusionView(scene, 0, 160, 90);
    const BoxVerdict verdict = BoxWitness(scene).judge(view, allBoxes(scene));
    std::vector<int> seen;
    for (const BoxVerdict::Row& row : verdict.boxes) seen.push_back(row.seen);
    EXPECT_EQ(seen, (std::vector<int>{1, 0, 1, 1, 0, 1, 0}));
    EXPECT_GT(verdict.edge_rays, 0u);
    EXPECT_GT(verdict.rays, verdict.edge_rays);
    // The camera looks along z, so x is to its left.
    EXPECT_LT(verdict.boxes[2].pixel.x, 80);
    EXPECT_NEAR(verdict.boxes[0].pixel.y, 45, 10);
}

// A hundredth of a pixel of 1280 is a four-hundredth of one here: samples and rays that are not aimed miss it.
TEST(BoxWitness, FindsGapsByTheEdgesBesideThem) {
    BoxRays blind, aimed;
    blind.at_boxes = 16;
    blind.through_edges = 0;
    blind.threads = aimed.threads = 2;
    const auto count = [&](double gap, const BoxRays& rays) {
        const OcclusionScene scene = makeOcclusionWall(WallBond::kGrid, gap);
        std::vector<uint32_t> behind(2000);
        std::iota(behind.begin(), behind.end(), 0u);
        return seenOf(BoxWitness(scene).judge(occlusionView(scene, 0, 320, 180), behind, rays));
    };
    EXPECT_EQ(count(0, aimed), 0u);
    EXPECT_GT(count(0.01, aimed), 3 * count(0.01, blind) + 100);
}

TEST(BoxWitness, SaysTheSameForAnyNumberOfThreads) {
    const OcclusionScene scene = makeOcclusionWall(WallBond::kTilted, 0.1);
    const BoxWitness witness(scene);
    const View view = occlusionView(scene, 1, 320, 180);
    std::vector<uint32_t> boxes(1500);
    std::iota(boxes.begin(), boxes.end(), 0u);
    BoxRays settings;
    const BoxVerdict one = witness.judge(view, boxes, settings);
    settings.threads = 3;
    const BoxVerdict three = witness.judge(view, boxes, settings);
    EXPECT_EQ(one.rays, three.rays);
    EXPECT_EQ(one.unconfirmed, three.unconfirmed);
    for (size_t i = 0; i < boxes.size(); ++i) {
        ASSERT_EQ(one.boxes[i].seen, three.boxes[i].seen) << i;
        ASSERT_EQ(one.boxes[i].pixel, three.boxes[i].pixel) << i;
    }
    EXPECT_GT(seenOf(one), 100u);
}

}  // namespace
}  // namespace sightline::bench
