// The law of coverage: no ray through a covered pixel gets past the depth that it claims.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <new>

#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

TEST(Tiles, CoverOnlyWhatRandomSheetsCover) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 16; ++seed) {
        Random random(seed);
        Drawing drawing(smallView());
        std::vector<Solid> solids;
        for (int i = 0; i < 3; ++i) {
            const float x = float(random.uniform(-3, 0)), y = float(random.uniform(-2, 0));
            const float z = float(random.uniform(-6, -2));
            const int n = 1 + int(random.below(8));
            solids.push_back(makeSheet(random, n, n, {x, y, z}, {x + 3, y + 2, z - float(random.uniform(-1, 3))},
                                       float(random.uniform(0, 0.3))));
        }
        drawing.drawAndResolve(solids);
        covered += drawing.coveredPixels();
        ASSERT_EQ(findLeak(drawing, seed, 12), "");
    }
    EXPECT_GT(covered, 16000u);
}

TEST(Tiles, CoverOnlyWhatTriangleSoupCovers) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        Drawing drawing(smallView());
        Solid soup;
        soup.double_sided.assign(60, seed % 2);
        for (int t = 0; t < 60; ++t) {
            const glm::vec3 center(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-6, -0.5));
            const double size = t % 4 ? random.uniform(0.01, 1.5) : random.uniform(1.0, 8.0);
            for (int k = 0; k < 3; ++k) {
                soup.indices.push_back(static_cast<uint32_t>(soup.positions.size()));
                soup.positions.push_back(center + glm::vec3(random.uniform(-size, size), random.uniform(-size, size),
                                                            random.uniform(-size, size)));
            }
        }
        drawing.drawAndResolve({soup});
        ASSERT_EQ(findLeak(drawing, seed, 12), "");
    }
}

TEST(Tiles, CoverOnlyWhatIsDrawnInParallelProjection) {
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        View view = smallView();
        view.projection = orthographic(4.0, 1.5, 0.1, 50.0);
        Drawing drawing(view);
        std::vector<Solid> solids{makeSheet(random, 6, 6, {-3, -2, -3}, {1, 2, -8}, 0.2f),
                                  makeSheet(random, 2, 3, {-1, -2, 0.5f}, {3, 2, -4}, 0.1f)};  // meets the near plane
        drawing.drawAndResolve(solids);
        EXPECT_GT(drawing.coveredPixels(), 1000u);
        ASSERT_EQ(findLeak(drawing, seed, 12), "");
    }
}

TEST(Tiles, CloseTheSeamsOfAJoinedSheet) {
    Random random(7);
    Drawing drawing(smallView(), {makeSheet(random, 13, 9, {-6, -4, -4}, {6, 4, -6}, 0.05f)});
    EXPECT_EQ(drawing.openPixels(), 0u);
    EXPECT_EQ(findLeak(drawing, 7, 8), "");
}

TEST(Tiles, CloseTheSeamsOfASheetOfTinyTriangles) {
    Random random(8);
    Drawing drawing(smallView(), {makeSheet(random, 300, 200, {-6, -4, -4}, {6, 4, -6}, 0.0f)});
    EXPECT_EQ(drawing.openPixels(), 0u);
}

TEST(Tiles, CloseTheSeamBetweenObjectsThatShareATransform) {
    Random random(9);
    Solid left = makeSheet(random, 3, 3, {-6, -4, -4}, {0.25f, 4, -4}, 0.0f);
    Solid right = makeSheet(random, 3, 3, {0.25f, -4, -4}, {6, 4, -4}, 0.0f);
    Drawing drawing(smallView(), {left, right});
    EXPECT_EQ(drawing.openPixels(), 0u);
}

TEST(Tiles, LeaveTheThinnestGapOpen) {
    Random random(10);
    for (float gap : {1e-6f, 1e-4f, 1e-2f, 0.3f}) {
        Solid left = makeSheet(random, 1, 3, {-6, -4, -4}, {0.25f, 4, -4}, 0.0f);
        Solid right = makeSheet(random, 1, 3, {0.25f + gap, -4, -4}, {6, 4, -4}, 0.0f);
        Drawing drawing(smallView(), {left, right});
        for (uint32_t y = 0; y < drawing.tiles.height; ++y) {
            uint32_t open = 0;
            for (uint32_t x = 0; x < drawing.tiles.width; ++x) open += !drawing.covered(x, y);
            EXPECT_GE(open, 1u) << "gap " << gap << " row " << y;
        }
    }
}

TEST(Tiles, AFanThatMeetsTheSilhouetteInAVertexLeavesItOpen) {
    // The triangle beside the tip owns no silhouette edge, but the pixel of the tip is not covered.
    Solid fan;
    fan.positions = {{0, 1, -4}, {-2, -2, -4}, {-0.5f, -2, -4}, {0.5f, -2, -4}, {2, -2, -4}};
    fan.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    Drawing drawing(smallView(), {fan});
    EXPECT_GT(drawing.coveredPixels(), 100u);
    EXPECT_EQ(findLeak(drawing, 11, 64), "");
}

TEST(Tiles, AFloorThroughTheNearPlaneCoversUpToIt) {
    Solid floor;
    floor.positions = {{-50, -0.5f, 50}, {50, -0.5f, 50}, {50, -0.5f, -200}, {-50, -0.5f, -200}};
    floor.indices = {0, 1, 2, 0, 2, 3};
    Drawing drawing(smallView(), {floor});
    EXPECT_GT(drawing.coveredPixels(), uint64_t{drawing.tiles.width} * drawing.tiles.height * 2 / 5);
    EXPECT_EQ(findLeak(drawing, 12, 16), "");
}

TEST(Tiles, ABackFaceHidesNothingUnlessItIsDoubleSided) {
    Random random(13);
    Solid sheet = makeSheet(random, 2, 2, {-6, -4, -4}, {6, 4, -4}, 0.0f);
    for (size_t t = 0; t < sheet.indices.size(); t += 3) std::swap(sheet.indices[t + 1], sheet.indices[t + 2]);
    Drawing single(smallView(), {sheet});
    EXPECT_EQ(single.coveredPixels(), 0u);
    sheet.double_sided.assign(sheet.indices.size() / 3, 1);
    Drawing both(smallView(), {sheet});
    EXPECT_EQ(both.openPixels(), 0u);
    sheet = makeSheet(random, 2, 2, {-6, -4, -4}, {6, 4, -4}, 0.0f);
    sheet.transform[0][0] = -1.0;  // a mirror turns the winding about, and a front face stays one
    Drawing mirrored(smallView(), {sheet});
    EXPECT_EQ(mirrored.openPixels(), 0u);
    EXPECT_EQ(findLeak(mirrored, 13, 4), "");
}

TEST(Tiles, AreTheSameFarFromTheOrigin) {
    for (double distance : {0.0, 1e6, 1e9}) {
        Random random(14);
        View view = smallView();
        const glm::dvec3 home(distance, -distance, 0.5 * distance);
        view.view = lookAt(home, home + glm::dvec3(0, 0, -1), {0, 1, 0});
        Solid sheet = makeSheet(random, 5, 5, {-6, -4, -4}, {6, 4, -6}, 0.05f);
        sheet.transform[3] = glm::dvec4(home, 1.0);
        Drawing drawing(view, {sheet});
        EXPECT_EQ(drawing.openPixels(), 0u) << distance;
    }
}

/// Memory that does not keep what it held once it is given back.
class ForgetfulMemory final : public Memory {
    void* allocate(size_t bytes, size_t alignment) override {
        return ::operator new (bytes, std::align_val_t{alignment});
    }
    void deallocate(void* at, size_t bytes, size_t alignment) override {
        std::memset(at, 0xff, bytes);
        ::operator delete (at, std::align_val_t{alignment});
    }
};

TEST(Tiles, ResolveByPolygonsThatMakingMoreHasMoved) {
    ForgetfulMemory forgetful;
    const auto claims = [&](size_t room) {
        std::vector<float> depths;
        Random random(16);
        Drawing drawing(smallView(), &forgetful);
        drawing.draw({makeSheet(random, 40, 30, {-3, -3, -2}, {2, 3, -9}, 0.1f),
                      makeSheet(random, 9, 9, {-5, -3, -6}, {5, 3, -6}, 0.2f)});
        drawing.tiles.polygons.reserve(room);
        for (uint32_t y = 0; y < drawing.tiles.height; ++y)
            for (uint32_t x = 0; x < drawing.tiles.width; ++x) {
                drawing.resolve(x, y);
                depths.push_back(drawing.depth(x, y));
            }
        return depths;
    };
    EXPECT_EQ(claims(0), claims(100000));
}

/// A sheet and a soup, drawn into some columns of tiles alone.
TEST(Tiles, OfSomeColumnsCoverWhatTheWholeCoversThere) {
    uint64_t covered = 0, other = 0, farther = 0;
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        std::vector<Solid> solids;
        for (int i = 0; i < 4; ++i) {
            const float x = float(random.uniform(-3, 0)), y = float(random.uniform(-2, 0)),
                        z = float(random.uniform(-6, -2));
            const int n = i == 0 ? 1 : 1 + int(random.below(12));
            solids.push_back(makeSheet(random, n, n, {x, y, z}, {x + 3, y + 2, z - float(random.uniform(-1, 3))},
                                       float(random.uniform(0, 0.2))));
        }
        Drawing whole(smallView()), part(smallView());
        const uint32_t columns = part.tiles.columns, first = static_cast<uint32_t>(random.below(columns));
        const uint32_t end = first + 1 + static_cast<uint32_t>(random.below(columns - first));
        part.tiles.keepColumns(first, end);
        whole.draw(solids);
        part.draw(solids);
        for (uint32_t y = 0; y < part.tiles.height; ++y)
            for (uint32_t x = 0; x < part.tiles.width; ++x) {
                if (x / 8 < first || x / 8 >= end) {
                    ASSERT_EQ(part.depth(x, y), std::numeric_limits<float>::infinity()) << x << ", " << y;
                    continue;
                }
                covered += whole.covered(x, y);
                other += part.covered(x, y) != whole.covered(x, y);
                farther += whole.covered(x, y) && !(part.depth(x, y) >= 0.98f * whole.depth(x, y));
            }
        PixelRect beside{0, 0, static_cast<int32_t>(8 * first) - 1, 7, 1e9f};
        EXPECT_FALSE(part.tiles.clip(beside));
        PixelRect across{0, 0, static_cast<int32_t>(8 * columns) - 1, 7, 1e9f};
        EXPECT_TRUE(part.tiles.clip(across));
        EXPECT_EQ(across.x0, static_cast<int32_t>(8 * first));
        EXPECT_EQ(across.x1, static_cast<int32_t>(8 * end) - 1);
        EXPECT_FALSE(isHidden(part.tiles, across));
        part.resolveAll();
        // The search for leaks asks all covered pixels; those beside are not truly so.
        for (uint32_t row = 0; row < part.tiles.rows; ++row)
            for (uint32_t column = 0; column < part.tiles.columns; ++column)
                if (column < first || column >= end)
                    part.tiles.base[row * part.tiles.stride + column] = DepthTiles::kOpen;
        ASSERT_EQ(findLeak(part, seed, 4), "");
    }
    EXPECT_GT(covered, 2000u);
    // Rounding may fall out otherwise; and of what is narrower there the depth is taken more coarsely.
    EXPECT_LE(other, covered / 100);
    EXPECT_LE(farther, covered / 50);
}

View viewWithoutJitter() {
    View view = smallView();
    view.jitter = 0;  // so that pixels of the view are those of the buffer
    return view;
}

/// A sheet that faces the eye, between places in pixels from the middle of the view.
Solid sheetOfPixels(double x0, double y0, double x1, double y1, double distance) {
    Random random(1);
    const double pixel = 2.0 * std::tan(0.5) * distance / 64.0;
    return makeSheet(random, 4, 4, glm::vec3(x0 * pixel, y0 * pixel, -distance),
                     glm::vec3(x1 * pixel, y1 * pixel, -distance), 0.0f);
}

TEST(Tiles, WithOneLayerKeepTheOneThatSaysMore) {
    for (const bool far_first : {false, true}) {
        Drawing drawing(viewWithoutJitter());
        drawing.tiles.clear(drawing.screen.width, drawing.screen.height, Detail::kMasked);
        const Solid near = sheetOfPixels(-10, -10, 18, 6.5, 2), far = sheetOfPixels(-10, -10, 2.5, 7.5, 50);
        if (far_first) drawing.draw({far, near});
        else drawing.draw({near, far});
        // Of the tile right of the middle and above it, the near sheet covers six rows, the far one two more pixels.
        for (uint32_t x = 48; x < 56; ++x)
            EXPECT_GT(drawing.depth(x, 34), 0.49f) << x << (far_first ? ", far first" : "");
        EXPECT_FALSE(drawing.covered(50, 39));
    }
}

TEST(Tiles, WithOneLayerKeepBothWhereTheyAreAlike) {
    Drawing drawing(viewWithoutJitter());
    drawing.tiles.clear(drawing.screen.width, drawing.screen.height, Detail::kMasked);
    drawing.draw({sheetOfPixels(-10, -10, 18, 3.5, 2), sheetOfPixels(-10, -10, 4.5, 6.5, 2.1)});
    EXPECT_GT(drawing.depth(54, 33), 0.47f);
    EXPECT_GT(drawing.depth(50, 37), 0.47f);
    EXPECT_FALSE(drawing.covered(54, 37));
}

TEST(Tiles, AreTheSameOnEveryInstructionSet) {
    std::vector<float> expected;
    const int targets = forEachTarget([&](const std::string& target) {
        Random random(15);
        Drawing drawing(smallView(200, 120), {makeSheet(random, 40, 30, {-3, -3, -2}, {2, 3, -9}, 0.1f),
                                              makeSheet(random, 3, 3, {-5, -3, -6}, {5, 3, -6}, 0.2f)});
        std::vector<float> depths;
        for (uint32_t y = 0; y < drawing.tiles.height; ++y)
            for (uint32_t x = 0; x < drawing.tiles.width; ++x) depths.push_back(drawing.depth(x, y));
        if (expected.empty()) expected = depths;
        EXPECT_TRUE(depths == expected) << target;
    });
    EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace sightline::test
