// The picture of an occlusion buffer: nearer is lighter, open is blue, the lowest row is at the bottom.
// SPDX-License-Identifier: MIT
#include "sightline/report/depth_picture.h"

#include <gtest/gtest.h>

#include <vector>

namespace sightline {
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

}  // namespace
}  // namespace sightline
