// The truth about boxes: a case that can be reckoned by hand, slits between samples, and bands.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_truth.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "bench/occlusion_frame.h"
#include "sightline/base/random.h"
#include "tests/bench/panel.h"

namespace sightline::bench {
using namespace studies;
namespace {

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
    EXPECT_EQ(boxesInSight(scene, frame.batches(), frame.boxes(), view, {}),
              boxesInSight(scene, frame.batches(), frame.boxes(), view, {.band_samples = 160 * 4 * 50}));
}

// Most boxes are passed over by the farthest depths of the picture's parts. The plain way is to draw each of them.
TEST(BoxTruth, SeesWhatAPlainZBufferShowsAndSaysWhere) {
    static constexpr uint32_t kSides[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                            2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    static constexpr uint8_t kNeverWrites[12] = {};
    const OcclusionScene scene = makeOcclusionScene("city");
    OcclusionFrame frame(scene);
    const View view = occlusionView(scene, scene.cameras.size() - 1, 320, 180);  // from above
    frame.begin(view);
    std::vector<glm::vec3> corners;
    for (uint32_t number : frame.boxes()) {
        const Box3f& box = scene.boxes[number];
        for (int k = 0; k < 8; ++k)
            corners.emplace_back(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                 k & 4 ? box.max.z : box.min.z);
    }
    std::vector<DrawItem> items;
    for (uint32_t batch : frame.batches()) items.emplace_back().mesh = scene.batches[batch].mesh();
    for (size_t i = 0; i < frame.boxes().size(); ++i) {
        DrawItem& item = items.emplace_back();
        item.mesh = {std::span(corners).subspan(8 * i, 8), kSides};
        item.writes_depth = kNeverWrites;
        item.id = static_cast<uint32_t>(i) + 1;
    }
    BoxTruthSettings settings{.supersampling = 2};
    ZBufferSettings plain{.samples = 2};
    Random random(settings.seed);
    plain.offset.x = random.uniform(-0.5, 0.5) / 2;
    plain.offset.y = random.uniform(-0.5, 0.5) / 2;
    const ZBufferImage image = renderZBuffer(items, view, plain);
    const std::vector<BoxSighting> seen = sightBoxes(scene, frame.batches(), frame.boxes(), view, settings);
    size_t count = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        ASSERT_EQ(seen[i].seen, image.seen[i + 1] != 0) << frame.boxes()[i];
        if (!seen[i].seen) continue;
        ++count;
        // The line of sight through that place meets the box.
        const Box3f& box = scene.boxes[frame.boxes()[i]];
        const glm::dvec2 clip = 2.0 * seen[i].pixel / glm::dvec2(320, 180) - 1.0;
        const glm::dvec4 far = glm::inverse(view.projection * view.view) * glm::dvec4(clip, 0.5, 1.0);
        const glm::dvec3 eye = eyePosition(view), direction = glm::dvec3(far) / far.w - eye;
        double from = 0, to = 1e9;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (box.min[axis] - eye[axis]) / direction[axis];
            const double b = (box.max[axis] - eye[axis]) / direction[axis];
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        ASSERT_LE(from, to + 1e-9) << frame.boxes()[i];
    }
    EXPECT_GT(count, 100u);
    EXPECT_LT(count, seen.size() / 2);
}

TEST(BoxTruth, IsTheSameForAnyNumberOfThreads) {
    const OcclusionScene scene = makeOcclusionWall(WallBond::kTilted, 0.1);
    OcclusionFrame frame(scene);
    const View view = occlusionView(scene, 1, 160, 90);
    frame.begin(view);
    BoxTruthSettings settings{.jitters = 5, .band_samples = 640 * 100};
    const std::vector<BoxSighting> one = sightBoxes(scene, frame.batches(), frame.boxes(), view, settings);
    settings.threads = 3;
    const std::vector<BoxSighting> three = sightBoxes(scene, frame.batches(), frame.boxes(), view, settings);
    for (size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(one[i].seen, three[i].seen);
        ASSERT_EQ(one[i].pixel, three[i].pixel);
    }
}

// The reason for more samples and for jitter: at pixel centres a slit of a tenth of a pixel is seen by chance alone.
TEST(BoxTruth, SeesMoreThroughSlitsWithMoreSamplesAndJitters) {
    const OcclusionScene scene = makeOcclusionWall(WallBond::kTilted, 0.1);
    OcclusionFrame frame(scene);
    const View view = occlusionView(scene, 0, 320, 180);
    frame.begin(view);
    const auto count = [&](uint32_t samples, uint32_t jitters) {
        const std::vector<uint8_t> seen =
            boxesInSight(scene, frame.batches(), frame.boxes(), view, {.supersampling = samples, .jitters = jitters});
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
