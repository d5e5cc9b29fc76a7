// PNGs that any reader takes, and base64 that any browser takes.
// SPDX-License-Identifier: MIT
#include "sightline/report/png.h"

#include <gtest/gtest.h>

#define STBI_ONLY_PNG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace sightline {
namespace {

TEST(Png, ReadsBackPixelByPixel) {
    Image<Rgb> image(37, 11);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) image.at(x, y) = Rgb(x * 6, y * 20, x * y);
    const std::string bytes = encodePng(image);
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                            static_cast<int>(bytes.size()), &width, &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 37);
    EXPECT_EQ(height, 11);
    ASSERT_EQ(channels, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(pixels[3 * i + size_t(c)], image.pixels[i][c]) << "pixel " << i;
    stbi_image_free(pixels);
}

TEST(Png, EmptyImageGivesNoBytes) { EXPECT_EQ(encodePng(Image<Rgb>()), ""); }

TEST(Png, Base64MatchesTheStandardsExamples) {  // RFC 4648, section 10
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace sightline
