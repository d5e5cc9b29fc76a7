// Dense meshes, whose polygons are small on the screen: the law of coverage for folds, slivers and sub-pixel triangles.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

/// A sheet of quads of about the given size on the screen, at distance 4; noise in widths of a quad.
Solid denseSheet(Random& random, int n, double pixels, float noise, glm::vec3 center) {
    const float size = static_cast<float>(pixels / 64.0 * 2.0 * 4.0 * std::tan(0.5));
    const glm::vec3 half(0.5f * size * n, 0.5f * size * n, 0);
    const float lean = size * static_cast<float>(random.uniform(-0.5 * n, 0.5 * n));
    return makeSheet(random, n, n, center - half, center + half + glm::vec3(0, 0, lean), noise * size);
}

TEST(DenseTiles, CoverOnlyWhatFoldedSheetsCover) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        Random random(seed);
        Drawing drawing(smallView(64, 48));
        const double pixels[] = {0.3, 1.0, 2.5, 7.0};
        const float noise[] = {0.0f, 0.4f, 2.5f};
        Solid sheet = denseSheet(random, seed % 4 == 0 ? 40 : 24, pixels[seed % 4], noise[seed % 3],
                                 {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -4});
        if (seed % 5 == 0) sheet.double_sided.assign(sheet.indices.size() / 3, 1);
        if (seed % 7 == 0) sheet.transform[0][0] = -1;
        drawing.drawAndResolve({sheet});
        covered += drawing.coveredPixels();
        ASSERT_EQ(findLeak(drawing, seed, 6), "");
    }
    EXPECT_GT(covered, 5000u);
}

TEST(DenseTiles, CoverOnlyWhatSliversCover) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        Random random(100 + seed);
        Drawing drawing(smallView(64, 48));
        // Rows of quads that are 300 times as long as wide, and lie aslant.
        Solid sheet = makeSheet(random, seed % 2 ? 2 : 200, seed % 2 ? 200 : 2, {-1.2f, -0.9f, -4}, {1.2f, 0.9f, -3},
                                seed % 3 == 0 ? 0.01f : 0.0f);
        sheet.transform = glm::dmat4(glm::dvec4(0.9, 0.3, 0, 0), glm::dvec4(-0.3, 0.9, 0, 0), glm::dvec4(0, 0, 1, 0),
                                     glm::dvec4(random.uniform(-1, 1), random.uniform(-1, 1), 0, 1));
        drawing.drawAndResolve({sheet});
        covered += drawing.coveredPixels();
        ASSERT_EQ(findLeak(drawing, seed, 6), "");
    }
    EXPECT_GT(covered, 5000u);
}

TEST(DenseTiles, CoverAllThatASmoothSheetCovers) {
    Random random(3);
    Drawing drawing(smallView(64, 48), {makeSheet(random, 30, 30, {-6, -5, -4}, {6, 5, -6}, 0.0f)});
    EXPECT_EQ(drawing.openPixels(), 0u);
    EXPECT_EQ(findLeak(drawing, 3, 6), "");
    // The depth is that of the sheet within what it changes over a tile.
    const RayCaster rays(drawing);
    for (uint32_t y = 0; y < drawing.tiles.height; y += 5)
        for (uint32_t x = 0; x < drawing.tiles.width; x += 5)
            EXPECT_GT(drawing.depth(x, y), rays.cast(x + 0.5, y + 0.5) * 0.93) << x << ", " << y;
}

TEST(DenseTiles, CoverOnlyWhatIsBeforeTheNearPlane) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(200 + seed);
        Drawing drawing(smallView(64, 48),
                        {makeSheet(random, 24, 24, {-1, -0.5f, -2}, {1, 0.5f, 2}, seed % 2 ? 0.0f : 0.05f)});
        ASSERT_EQ(findLeak(drawing, seed, 6), "");
    }
}

TEST(DenseTiles, AreTheSameOnEveryInstructionSet) {
    std::vector<float> expected;
    std::vector<uint64_t> expected_seams;
    const int targets = forEachTarget([&](const std::string& target) {
        Random random(15);
        Drawing drawing(smallView(200, 120));
        drawing.draw({makeSheet(random, 60, 60, {-2, -2, -2}, {1.5f, 2, -9}, 0.03f),
                      makeSheet(random, 40, 40, {-1, -1, -3}, {1, 1, -3}, 0.2f)});
        std::vector<float> depths;
        std::vector<uint64_t> seams;
        for (uint32_t y = 0; y < drawing.tiles.height; ++y)
            for (uint32_t x = 0; x < drawing.tiles.width; ++x) depths.push_back(drawing.depth(x, y));
        for (uint32_t t = 0; t < drawing.tiles.base.size(); ++t) seams.push_back(drawing.tiles.seamBits(t));
        if (expected.empty()) {
            expected = depths;
            expected_seams = seams;
        }
        EXPECT_TRUE(depths == expected) << target;
        EXPECT_TRUE(seams == expected_seams) << target;
    });
    EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace sightline::test
