// The image of the occlusion buffer says of each pixel what a test of that pixel alone would say.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/depth_image.h"

#include <gtest/gtest.h>

#include "tests/buffer/tiles_fixture.h"

namespace sightline::test {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

std::vector<Solid> someSheets(uint64_t seed) {
    Random random(seed);
    std::vector<Solid> solids;
    for (int i = 0; i < 4; ++i) {
        const float x = float(random.uniform(-4, 0)), y = float(random.uniform(-3, 0));
        const float z = float(random.uniform(-6, -2));
        const int n = 1 + int(random.below(6));
        solids.push_back(makeSheet(random, n, n, {x, y, z}, {x + 4, y + 3, z - float(random.uniform(-1, 3))},
                                   float(random.uniform(0, 0.3))));
    }
    return solids;
}

/// How many pixels claim a depth; each must hide all that is farther, and nothing else.
uint64_t agreeing(Drawing& drawing, Seams seams) {
    const size_t pixels = size_t{drawing.tiles.width} * drawing.tiles.height;
    std::vector<float> nearness(pixels, 7.0f);
    std::vector<uint8_t> covered(pixels, 7);
    readDepthImage(drawing.tiles, seams, nearness, covered);
    uint64_t claims = 0;
    for (size_t i = 0; i < pixels; ++i) {
        const int32_t x = static_cast<int32_t>(i % drawing.tiles.width);
        const int32_t y = static_cast<int32_t>(i / drawing.tiles.width);
        const auto hides = [&](float at) { return isHidden(drawing.tiles, {x, y, x, y, at}, seams); };
        EXPECT_EQ(covered[i], nearness[i] > -kInfinite) << x << ", " << y;
        EXPECT_FALSE(hides(nearness[i])) << x << ", " << y;
        claims += covered[i];
        if (!covered[i]) continue;
        EXPECT_TRUE(hides(std::nextafter(nearness[i], -kInfinite))) << x << ", " << y;
    }
    return claims;
}

TEST(DepthImage, ClaimsWhatTestsOfSinglePixelsFind) {
    uint64_t left = 0, resolved = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        View view = smallView();
        if (seed % 3 == 0) view.projection = orthographic(4.0, 1.5, 0.1, 50.0);
        Drawing drawing(view);
        drawing.draw(someSheets(seed));
        left += agreeing(drawing, Seams::kLeave);
        resolved += agreeing(drawing, Seams::kResolve);
    }
    EXPECT_GT(left, 4000u);
    EXPECT_GE(resolved, left);
}

TEST(DepthImage, OfAnEmptyBufferIsOpen) {
    Drawing drawing(smallView());
    std::vector<float> nearness(size_t{drawing.tiles.width} * drawing.tiles.height, 1.0f);
    readDepthImage(drawing.tiles, Seams::kResolve, nearness);
    for (const float at : nearness) ASSERT_EQ(at, -kInfinite);
    readDepthImage(drawing.tiles, Seams::kLeave, nearness, {}, 0.0f);
    for (const float at : nearness) ASSERT_EQ(at, 0.0f);
}

}  // namespace
}  // namespace sightline::test
