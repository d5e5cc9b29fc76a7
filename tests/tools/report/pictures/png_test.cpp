// PNGs that any reader takes, and base64 that any browser takes.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/png.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "tests/support/png.h"

namespace sightline {
using namespace tools;
namespace {

TEST(Png, ReadsBackPixelByPixel) {
    Image<Rgb> image(37, 11);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) image.at(x, y) = Rgb(x * 6, y * 20, x * y);
    const std::string bytes = encodePng(image);
    const test::Decoded read = test::decodePng(bytes);
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 11);
    ASSERT_EQ(read.channels, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(read.bytes[3 * i + size_t(c)], image.pixels[i][c]) << "pixel " << i;
}

TEST(Png, EmptyImageGivesNoBytes) { EXPECT_EQ(encodePng(Image<Rgb>()), ""); }

TEST(Png, PaletteReadsBackPixelByPixelAndIsSmaller) {
    Image<glm::u8vec4> image(53, 29);
    Random random(3);
    for (glm::u8vec4& pixel : image.pixels) {
        const auto colour = static_cast<uint8_t>(random.below(40));
        pixel = glm::u8vec4(colour * 6, 255 - colour, colour * colour % 251, colour % 3 ? 255 : 60);
    }
    const std::string bytes = encodePalettePng(image);
    EXPECT_EQ(bytes[25], 3);  // colour type: palette
    EXPECT_LT(bytes.size(), encodePng(image).size());
    const test::Decoded read = test::decodePng(bytes, 4);
    ASSERT_EQ(read.width, 53);
    ASSERT_EQ(read.height, 29);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 4; ++c) ASSERT_EQ(read.bytes[4 * i + size_t(c)], image.pixels[i][c]) << "pixel " << i;
}

TEST(Png, PaletteOfTooManyColoursIsAPlainPng) {
    Image<Rgb> image(32, 32);
    for (uint32_t i = 0; i < 1024; ++i) image.pixels[i] = Rgb(i % 256, i / 256, 0);
    EXPECT_EQ(encodePalettePng(image), encodePng(image));
    EXPECT_EQ(encodePalettePng(Image<Rgb>()), "");
}

TEST(Png, JpegIsNearThePicture) {
    const Image<Rgb> image(40, 24, Rgb(200, 100, 50));
    const std::string bytes = encodeJpeg(image, 90);
    const test::Decoded read = test::decodePng(bytes, 3);
    ASSERT_EQ(read.width, 40);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.bytes[3 * 500 + size_t(c)], image.pixels[500][c], 6);
    EXPECT_EQ(dataUri(bytes).substr(0, 23), "data:image/jpeg;base64,");
    EXPECT_EQ(encodeJpeg(Image<Rgb>(), 90), "");
}

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
