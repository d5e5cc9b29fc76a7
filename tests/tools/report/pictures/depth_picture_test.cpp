// The picture of an occlusion buffer: nearer is lighter, open is blue, the lowest row is at the bottom.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/depth_picture.h"

#include <gtest/gtest.h>

#include <vector>

namespace sightline {
using namespace tools;
namespace {

TEST(DepthPicture, IsGreyByTheLogarithmOfTheDistance) {
    const std::vector<float> nearness{1.0f, 0.1f, 0.01f, 0.0f};  // 1, 10, 100 away, and open
    const std::vector<uint8_t> covered{1, 1, 1, 0};
    const Image<Rgb> image = depthPicture({2, 2, true, nearness, covered});
    EXPECT_EQ(image.at(0, 1), Rgb(244));
    EXPECT_EQ(image.at(1, 1), Rgb(134));
    EXPECT_EQ(image.at(0, 0), Rgb(24));
    EXPECT_EQ(image.at(1, 0), kOpenPixel);
}

TEST(DepthPicture, IsGreyByTheDistanceInParallelViews) {
    const std::vector<float> nearness{-1.0f, -2.0f, 0.0f};  // 1 and 2 before the eye's plane, and in it
    const Image<Rgb> image = depthPicture({3, 1, false, nearness, std::vector<uint8_t>{1, 1, 1}});
    EXPECT_EQ(image.at(0, 0), Rgb(134));
    EXPECT_EQ(image.at(1, 0), Rgb(24));
    EXPECT_EQ(image.at(2, 0), Rgb(244));
}

TEST(DepthPicture, OfAnOpenBufferIsAllOpen) {
    const std::vector<float> nearness(6, 0.0f);
    const std::vector<uint8_t> covered(6, 0);
    for (const Rgb& pixel : depthPicture({3, 2, true, nearness, covered}).pixels) EXPECT_EQ(pixel, kOpenPixel);
    EXPECT_TRUE(depthPicture({}).pixels.empty());
}

// A buffer of 16x10 pixels holds a viewport of 12x6 and two pixels of jitter on every side: its own pixels are the
// viewport's, and what shows is the middle.
TEST(ViewportPart, LeavesOutTheRimThatTheJitterNeeds) {
    Image<Rgb> buffer(16, 10, Rgb(0));
    for (uint32_t y = 0; y < 10; ++y)
        for (uint32_t x = 0; x < 16; ++x) buffer.at(x, y) = Rgb(static_cast<uint8_t>(16 * y + x), 0, 0);
    const Image<Rgb> part = viewportPart(buffer, {12, 6}, 2.0, 12, 6);
    ASSERT_EQ(part.width, 12u);
    ASSERT_EQ(part.height, 6u);
    for (uint32_t y = 0; y < 6; ++y)
        for (uint32_t x = 0; x < 12; ++x) EXPECT_EQ(part.at(x, y), buffer.at(x + 2, y + 2)) << x << ", " << y;
    // Pixels that are not square, at another size: from a quarter to three quarters of the height.
    const Image<Rgb> tall = viewportPart(buffer, {16, 5}, 2.5, 4, 2);
    EXPECT_EQ(tall.at(0, 0).x / 16, 3);
    EXPECT_EQ(tall.at(3, 1).x / 16, 6);
    EXPECT_EQ(viewportPart({}, {16, 9}, 0.5, 2, 2).pixels, std::vector<Rgb>(4, kOpenPixel));
}

}  // namespace
}  // namespace sightline
