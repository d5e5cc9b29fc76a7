// The truth about boxes: a case that can be reckoned by hand, slits between samples, and bands.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_truth.h"

#include <numeric>

#include <gtest/gtest.h>

#include "bench/occlusion_frame.h"

namespace sightline::bench {
namespace {

/// A wall of one panel at z = 10, 4 wide and 4 high, and what the caller puts around it; the camera looks along z.
OcclusionScene onePanel(std::vector<Box3f> boxes) {
    OcclusionScene scene{"panel", 1.0, {OcclusionCamera()}, {}, std::move(boxes)};
    OccluderBatch panel;
    panel.positions = {{-2, -2, 10}, {-2, 2, 10}, {2, 2, 10}, {2, -2, 10}};
    panel.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& p : panel.positions) panel.bounds.grow(p);
    scene.batches.push_back(panel);
    return scene;
}

Box3f cube(float x, float y, float z, float half) {
    Box3f box;
    box.min = glm::vec3(x, y, z) - half;
    box.max = glm::vec3(x, y, z) + half;
    return box;
}

TEST(BoxTruth, SeesWhatStandsBeforeBesideAndAtThePanel) {
    const OcclusionScene scene = onePanel({
        cube(0, 0, 8, 0.5f),      // before
        cube(0, 0, 15, 1),        // behind
        cube(4, 0, 15, 0.5f),     // behind, and beside: the panel ends at x = 3 there
        cube(2.8f, 0, 15, 0.5f),  // behind, half of it beside
        cube(0, 0, 10.5f, 0.5f),  // its front lies in the panel's plane
    });
    const std::vector<uint32_t> batches{0}, boxes{0, 1, 2, 3, 4};
    const View view = occlusionView(scene, 0, 160, 90);
    const std::vector<uint8_t> expected{1, 0, 1, 1, 1};
    EXPECT_EQ(boxesInSight(scene, batches, boxes, view, {}), expected);
    EXPECT_EQ(boxesInSight(scene, {}, boxes, view, {}), std::vector<uint8_t>(5, 1));
}

TEST(BoxTruth, DoesNotDependOnBands) {
    const OcclusionScene scene = makeOcclusionWall(WallBond::kBrick, 0.1);
    OcclusionFrame frame(scene);
    const View view = occlusionView(scene, 1, 160, 90);
    frame.begin(view);
    BoxTruthSettings bands;
    bands.band_samples = 160 * 4 * 50;
    EXPECT_EQ(boxesInSight(scene, frame.batches(), frame.boxes(), view, {}),
              boxesInSight(scene, frame.batches(), frame.boxes(), view, bands));
}

// The reason for more samples and for jitter: at pixel centres a slit of a tenth of a pixel is seen by chance alone.
TEST(BoxTruth, SeesMoreThroughSlitsWithMoreSamplesAndJitters) {
    const OcclusionScene scene = makeOcclusionWall(WallBond::kTilted, 0.1);
    OcclusionFrame frame(scene);
    const View view = occlusionView(scene, 0, 320, 180);
    frame.begin(view);
    const auto count = [&](uint32_t samples, uint32_t jitters) {
        BoxTruthSettings settings;
        settings.supersampling = samples;
        settings.jitters = jitters;
        const std::vector<uint8_t> seen = boxesInSight(scene, frame.batches(), frame.boxes(), view, settings);
        return std::accumulate(seen.begin(), seen.end(), 0);
    };
    EXPECT_LT(count(1, 1), count(4, 1));
    EXPECT_LT(count(4, 1), count(4, 4));
}

TEST(PlainBoxTest, ComparesEveryPixel) {
    ZBufferImage image;
    image.width = image.height = 8;
    image.depth.assign(64, 0.5);
    PixelRect rect;
    rect.x0 = rect.y0 = 1;
    rect.x1 = rect.y1 = 6;
    rect.nearness = 0.4f;
    EXPECT_TRUE(isBehind(image, rect));
    rect.nearness = 0.5f;  // equality is visible
    EXPECT_FALSE(isBehind(image, rect));
    rect.nearness = 0.4f;
    image.depth[6 * 8 + 6] = 0.3;
    EXPECT_FALSE(isBehind(image, rect));
    rect.x1 = 5;
    EXPECT_TRUE(isBehind(image, rect));
}

}  // namespace
}  // namespace sightline::bench
