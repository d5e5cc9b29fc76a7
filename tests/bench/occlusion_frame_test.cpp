// A frame of an occlusion scene: groups answer as their members do, and nothing in sight is hidden.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_frame.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "bench/occlusion_truth.h"
#include "sightline/buffer/depth_image.h"

namespace sightline::bench {
using namespace studies;
namespace {

TEST(MortonOrder, IsAPermutationThatKeepsNeighboursTogether) {
    const OcclusionScene scene = makeOcclusionIndoor();
    const std::vector<uint32_t> order = mortonOrder(scene.boxes);
    std::vector<uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<uint32_t> all(scene.boxes.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(sorted, all);
    double along = 0, unsorted = 0;
    for (size_t i = 1; i < order.size(); ++i) {
        along += glm::length(scene.boxes[order[i]].center() - scene.boxes[order[i - 1]].center());
        unsorted += glm::length(scene.boxes[i].center() - scene.boxes[i - 1].center());
    }
    EXPECT_LT(along, 0.1 * unsorted);
}

class Frames : public ::testing::TestWithParam<const char*> {};

// At a low resolution a pixel holds more, so that a wrong answer is more likely.
TEST_P(Frames, HideNothingThatIsInSightAndAnswerAlikeInGroups) {
    const OcclusionScene scene = makeOcclusionScene(GetParam());
    OcclusionFrame frame(scene);
    DepthTiles tiles;
    size_t culled = 0;
    for (size_t camera = 0; camera < std::min<size_t>(2, scene.cameras.size()); ++camera) {
        const View view = occlusionView(scene, camera, 160, 96);
        frame.begin(view);
        std::vector<uint8_t> flat(frame.boxes().size()), grouped = flat, all_drawn = flat;
        frame.rasterize(tiles, OcclusionFrame::SelfTest::kNo);
        frame.testFlat(tiles, all_drawn);
        EXPECT_LE(frame.rasterize(tiles), scene.triangles());
        frame.testFlat(tiles, flat);
        frame.rasterize(tiles);
        frame.testGrouped(tiles, grouped);
        const std::vector<uint8_t> seen = boxesInSight(scene, frame.batches(), frame.boxes(), view, {});
        for (size_t i = 0; i < seen.size(); ++i) {
            ASSERT_FALSE(seen[i] && flat[i]) << GetParam() << " camera " << camera << " box " << frame.boxes()[i];
            ASSERT_FALSE(seen[i] && grouped[i]) << GetParam() << " camera " << camera << " box " << frame.boxes()[i];
            ASSERT_FALSE(seen[i] && all_drawn[i]) << GetParam() << " camera " << camera << " box " << frame.boxes()[i];
            culled += flat[i];
        }
        // A hidden group hides its members; a member may be hidden although its group is not.
        EXPECT_EQ(flat, grouped);
    }
    EXPECT_GT(culled, 0u);
}

INSTANTIATE_TEST_SUITE_P(Occlusion, Frames,
                         ::testing::Values("city", "indoor", "soup-side", "wall-grid-0", "wall-brick-0",
                                           "wall-tilted-0", "wall-tilted-0.1"));

}  // namespace
}  // namespace sightline::bench
