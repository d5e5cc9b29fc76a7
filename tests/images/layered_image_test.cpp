// Laws of layered depth images: what they take over, merge, and see behind.
// SPDX-License-Identifier: MIT
#include "sightline/images/layered_image.h"

#include <gtest/gtest.h>

#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

const glm::dvec3 kMiddle(0.5, 1.2, 1.5);

std::vector<DepthImage> takenAround(const DoorwayRoom& room) {
    std::vector<DepthImage> references = {room.take(kMiddle, 60, 120)};
    for (const glm::dvec3& step : {glm::dvec3(-0.6, 0, 0), glm::dvec3(0.6, 0, 0), glm::dvec3(0, 0, 0.6)})
        references.push_back(room.take(kMiddle + step, 60, 120));
    return references;
}

TEST(LayeredImage, TakesItsOwnViewOverExactly) {
    const DoorwayRoom room(1);
    const std::vector<DepthImage> references = takenAround(room);
    for (const size_t count : {size_t{1}, references.size()}) {
        const LayeredImage layered = layeredImage(std::span(references).first(count), references[0].view);
        for (size_t at = 0; at < references[0].samples.size(); ++at) {
            ASSERT_LT(layered.first[at], layered.first[at + 1]);
            const DepthSample& front = layered.samples[layered.first[at + 1] - 1];
            const DepthSample& own = references[0].samples[at];
            if (front.from_behind) continue;
            ASSERT_EQ(front.colour, own.colour) << "sample " << at << " of " << count;
            ASSERT_NEAR(front.nearness, own.nearness, 1e-6);
        }
    }
}

TEST(LayeredImage, MergesWhatIsTheSame) {
    const DoorwayRoom room(2);
    const DepthImage image = room.take(kMiddle, 60, 120);
    const std::vector<DepthImage> twice = {image, image};
    const LayeredImage layered = layeredImage(twice, image.view);
    EXPECT_EQ(layered.samples.size(), image.samples.size());
    EXPECT_EQ(layered.mostLayers(), 1u);
    EXPECT_EQ(layered.bytes(), image.bytes() + (image.samples.size() + 1) * sizeof(uint32_t));
}

TEST(LayeredImage, KeepsLayersFarToNearAndNoMoreThanAllowed) {
    const DoorwayRoom room(3);
    const std::vector<DepthImage> references = takenAround(room);
    for (const uint32_t most : {1u, 2u, 8u}) {
        const LayeredImage layered = layeredImage(references, references[0].view, {.most_layers = most});
        EXPECT_LE(layered.mostLayers(), most);
        EXPECT_GT(layered.mostLayers(), most > 1 ? 1u : 0u);
        for (size_t at = 0; at + 1 < layered.first.size(); ++at)
            for (uint32_t k = layered.first[at] + 1; k < layered.first[at + 1]; ++k)
                ASSERT_GE(layered.samples[k].nearness, layered.samples[k - 1].nearness);
    }
}

TEST(LayeredImage, LeavesFewerHolesThanOneReference) {
    size_t alone = 0, together = 0;
    Random random(4);
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        const DoorwayRoom room(seed, 20);
        const std::vector<DepthImage> references = takenAround(room);
        const PortalFrame wide = widened(madeDoorway(), {0.5, 1});
        const View view = *portalView(wide, kMiddle, 120, 240);
        const LayeredImage layered = layeredImage(references, view);
        const View to = *portalView(madeDoorway(), kMiddle + randomVector(random, {0.5, 0.0, 0.3}), 60, 120);
        WarpedImage one(to), many(to);
        warp(references[0], to, one);
        warp(layered.view, layered.lists(), to, many);
        alone += one.holes();
        together += many.holes();
    }
    EXPECT_GT(alone, 500u);
    EXPECT_LT(3 * together, alone) << together << " holes of " << alone;
}

TEST(LayeredImage, IsDrawnInOrderAsAZBufferDrawsIt) {
    const DoorwayRoom room(5, 20);
    const std::vector<DepthImage> references = takenAround(room);
    const LayeredImage layered = layeredImage(references, references[0].view);
    const View to = *portalView(madeDoorway(), kMiddle + glm::dvec3(0.3, 0, 0), 60, 120);
    for (const double gap : {0.0, 1.0}) {
        WarpedImage in_order(to), by_depth(to);
        warp(layered.view, layered.lists(), to, in_order, {.most_gap = gap});
        warp(layered.view, layered.lists(), to, by_depth, {.hidden_by = HiddenBy::kZBuffer, .most_gap = gap});
        size_t differing = 0;
        for (size_t at = 0; at < in_order.nearness.size(); ++at)
            differing += in_order.nearness[at] >= 0 && by_depth.nearness[at] > 1.01f * in_order.nearness[at];
        // Rims that closing gaps has moved may lie over what comes later.
        EXPECT_LT(differing, in_order.nearness.size() / (gap > 0 ? 100 : 1000)) << "gap " << gap;
    }
}

}  // namespace
}  // namespace sightline::test
