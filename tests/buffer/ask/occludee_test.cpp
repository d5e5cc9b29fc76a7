// The law of occludees: every pixel that a ray meets the polygon in is named, and no ray hits nearer than was said.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/ask/occludee.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "sightline/buffer/draw/outline.h"
#include "sightline/cull/occlusion.h"
#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

/// The pixels of outlines over a whole buffer; -infinity where they are not.
struct Painted : OutlineSink {
    DepthTiles tiles;
    std::vector<float> nearest;

    explicit Painted(const Screen& screen)
        : nearest(size_t{screen.width} * screen.height, -std::numeric_limits<float>::infinity()) {
        tiles.clear(screen.width, screen.height);
    }

    /// @returns false if something is not known
    bool paint(const Screen& screen, const Solid& solid) {
        const Occluder shape = prepareOccluder({solid.positions, solid.indices}, {}, solid.double_sided);
        const OccluderInstance instance = makeOccluderInstance(screen, shape, solid.transform);
        bool known = true;
        for (uint32_t c = 0; c < shape.clusters.size(); ++c)
            known &= forOutline(tiles, instance.frame, shape, c, OutlineOf::kAll, *this).known;
        return known;
    }

    bool take(uint32_t tile, uint64_t mask, float near) override {
        for (; mask; mask &= mask - 1) {
            const uint32_t bit = static_cast<uint32_t>(std::countr_zero(mask));
            float& place = nearest[size_t{8 * (tile / tiles.stride) + bit / 8} * tiles.width +
                                   8 * (tile % tiles.stride) + bit % 8];
            place = std::max(place, near);
        }
        return true;
    }
};

/// A triangle or a flat quadrangle somewhere about the view: large, small, sliver, through the near plane.
Solid randomPolygon(Random& random, int round) {
    Solid solid;
    const double size = std::pow(10.0, random.uniform(-2.0, 1.0));
    const glm::vec3 middle(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-9, -0.3));
    const auto jump = [&] {
        return glm::vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    };
    const glm::vec3 u = jump(), v = round % 7 == 0 ? u + 1e-4f * jump() : jump();
    solid.positions = {middle, middle + u, middle + u + v, middle + v};
    solid.indices = {0, 1, 2};
    if (round % 2) solid.indices.insert(solid.indices.end(), {0, 2, 3});
    if (round % 3 == 0) solid.double_sided.assign(solid.indices.size() / 3, 1);
    if (round % 5 == 0) solid.transform[0] = -solid.transform[0];
    return solid;
}

struct OccludeesTried {
    uint64_t hits = 0, pixels = 0, spare = 0, unknown = 0;
};

/// Paints one polygon and holds it to rays.
void expectRaysInside(uint64_t seed, int round, OccludeesTried& tried) {
    Random random(seed * 1000 + static_cast<uint64_t>(round));
    View view = smallView();
    if (round % 4 == 3) view.projection = orthographic(6, 1.5, 0.1, 100);
    Drawing drawing(view);
    drawing.solids = {randomPolygon(random, round)};
    const Solid& solid = drawing.solids[0];
    Painted painted(drawing.screen);
    if (!painted.paint(drawing.screen, solid)) {
        ++tried.unknown;
        return;
    }
    std::vector<uint8_t> near_hit(painted.nearest.size(), 0);
    const RayCaster rays(drawing);
    const int width = static_cast<int>(drawing.screen.width), height = static_cast<int>(drawing.screen.height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const size_t at = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
            for (int i = 0; i < 3; ++i) {
                const double truth = rays.cast(x + random.uniform(), y + random.uniform());
                if (truth == -std::numeric_limits<double>::infinity()) continue;
                ++tried.hits;
                ASSERT_GE(painted.nearest[at], truth)
                    << "seed " << seed << " round " << round << " at " << x << ", " << y;
                for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
                    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) near_hit[v * width + u] = 1;
            }
        }
    for (size_t i = 0; i < near_hit.size(); ++i) {
        const bool named = painted.nearest[i] > -std::numeric_limits<float>::infinity();
        tried.pixels += named;
        tried.spare += named && !near_hit[i];
    }
}

TEST(Occludee, NamesEveryPixelThatARayMeetsItIn) {
    OccludeesTried tried;
    for (uint64_t seed = 1; seed <= 4; ++seed)
        for (int round = 0; round < 60; ++round) {
            expectRaysInside(seed, round, tried);
            if (HasFatalFailure()) return;
        }
    EXPECT_GT(tried.hits, 50000u);
    EXPECT_LT(tried.unknown, 12u);
    EXPECT_LT(tried.spare, tried.pixels / 20) << "few pixels are named that no ray comes near";
}

TEST(Occludee, IsTheSameOnEveryInstructionSet) {
    std::vector<std::vector<float>> all;
    forEachTarget([&](const std::string&) {
        std::vector<float> values;
        for (int round = 0; round < 40; ++round) {
            Random random(static_cast<uint64_t>(round));
            const Drawing drawing(smallView());
            const Solid solid = randomPolygon(random, round);
            Painted painted(drawing.screen);
            painted.paint(drawing.screen, solid);
            values.insert(values.end(), painted.nearest.begin(), painted.nearest.end());
        }
        all.push_back(values);
    });
    for (const std::vector<float>& values : all) EXPECT_EQ(values, all[0]);
}

TEST(Occludee, ASliverAndAPointAreNamed) {
    const double x[3] = {4.5, 20.5, 12.5}, y[3] = {4.5, 4.5, 4.5}, d[3] = {1, 2, 1.5};
    OccludeePolygon polygon;
    ASSERT_EQ(makeOccludeePolygon(x, y, d, 3, 0, 0, 64, 64, polygon), Sight::kOccluded);
    float nearest[64];
    EXPECT_EQ(occludeePixels(polygon, 0, 0, nearest), 0xf000000000ull) << "from pixel 4 on, in row 4";
    EXPECT_GE(nearest[36], 1.0f);
    const double px[3] = {9, 9, 9}, py[3] = {9, 9, 9};
    ASSERT_EQ(makeOccludeePolygon(px, py, d, 3, 0, 0, 64, 64, polygon), Sight::kOccluded);
    EXPECT_EQ(occludeePixels(polygon, 1, 1, nearest), 0x0303ull) << "all four that the corner may touch";
    EXPECT_GE(nearest[0], 2.0f);
}

TEST(Occludee, WhatIsNotANumberIsVisibleAndWhatIsAsideIsOutside) {
    const double x[3] = {4, 20, std::numeric_limits<double>::quiet_NaN()}, y[3] = {4, 4, 9}, d[3] = {1, 1, 1};
    OccludeePolygon polygon;
    EXPECT_EQ(makeOccludeePolygon(x, y, d, 3, 0, 0, 64, 64, polygon), Sight::kVisible);
    const double far[3] = {1e12, -1e12, 0}, aside[3] = {65, 70, 80};
    EXPECT_EQ(makeOccludeePolygon(far, y, d, 3, 0, 0, 64, 64, polygon), Sight::kVisible);
    EXPECT_EQ(makeOccludeePolygon(aside, y, d, 3, 0, 0, 64, 64, polygon), Sight::kOutside);
}

}  // namespace
}  // namespace sightline::test
