// What reference images know of the surfaces that they show.
// SPDX-License-Identifier: MIT
#include "sightline/images/depth_image.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

TEST(DepthImage, HasTheNearnessOfTheReference) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const DoorwayRoom room(seed);
        const View view = *portalView(madeDoorway(), {0.2, 1.4, 1.1}, 60, 120);
        const DepthImage image = room.take(view);
        const ZBufferImage truth = renderZBuffer(room.items(), view);
        ASSERT_EQ(image.samples.size(), truth.depth.size());
        size_t differing = 0;
        for (size_t i = 0; i < truth.depth.size(); ++i) {
            const double expected = truth.id[i] == ZBufferImage::kNone ? 0 : truth.depth[i];
            differing += std::abs(image.samples[i].nearness - expected) > 1e-5 * expected;
        }
        EXPECT_LE(differing, 3u) << "but for samples on an edge";
    }
}

TEST(DepthImage, SlopesFollowThePlaneThroughTheNeighbours) {
    const DoorwayRoom room(5, 0);
    const View view = *portalView(madeDoorway(), {0.7, 1.1, 1.6}, 60, 120);
    const DepthImage image = room.take(view);
    const HiddenImage shown = render(DrawList(room.items()), view, {});
    size_t compared = 0;
    for (uint32_t row = 0; row + 1 < 120; ++row)
        for (uint32_t i = 0; i + 1 < 60; ++i) {
            const size_t at = row * 60 + i;
            if (shown.surface[at] == HiddenImage::kNone) continue;
            const DepthSample& sample = image.samples[at];
            if (shown.surface[at + 1] == shown.surface[at]) {
                EXPECT_NEAR(sample.nearness + sample.per_sample, image.samples[at + 1].nearness, 1e-6);
            }
            if (shown.surface[at + 60] == shown.surface[at]) {
                EXPECT_NEAR(sample.nearness + sample.per_row, image.samples[at + 60].nearness, 1e-6);
                ++compared;
            }
        }
    EXPECT_GT(compared, 5000u);
}

TEST(DepthImage, IsInfinitelyFarWhereNothingIs) {
    const DepthImage image = takeImage(DrawList({}), *portalView(madeDoorway(), {0.5, 1, 1}, 8, 8), {});
    for (const DepthSample& sample : image.samples) {
        EXPECT_EQ(sample.nearness, 0);
        EXPECT_EQ(sample.per_sample, 0);
        EXPECT_NE(sample.colour, glm::u8vec3(0)) << "the sky has a colour";
    }
    EXPECT_EQ(image.bytes(), 64 * sizeof(DepthSample));
}

}  // namespace
}  // namespace sightline::test
