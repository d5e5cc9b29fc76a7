// Pixels that polygons share: what masks refute stays open, and what was asked before changes no answer.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "sightline/buffer/seam/seam.h"
#include "tests/buffer/tiles_fixture.h"

namespace sightline::test {
namespace {

/// Triangles in no order that overlap, some of them joined, before two sheets that share an edge.
std::vector<Solid> mixedScene(Random& random) {
    Solid soup;
    for (int t = 0; t < 150; ++t) {
        const glm::vec3 center(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-6, -3));
        const double size = random.uniform(0.1, 0.6);
        for (int k = 0; k < 3; ++k) {
            soup.indices.push_back(static_cast<uint32_t>(soup.positions.size()));
            soup.positions.push_back(center + glm::vec3(random.uniform(-size, size), random.uniform(-size, size),
                                                        random.uniform(-0.1, 0.1)));
        }
    }
    soup.double_sided.assign(soup.indices.size() / 3, 1);
    return {soup, makeSheet(random, 8, 5, {-3, -2, -4}, {0.1f, 1, -5}, 0.1f),
            makeSheet(random, 2, 2, {0.25f, -1, -7}, {1, 2, -7}, 0.0f),
            makeSheet(random, 2, 2, {1, -1, -7}, {3, 2, -7}, 0.0f)};
}

PixelRect randomRect(Random& random, const DepthTiles& tiles) {
    PixelRect rect{.x0 = static_cast<int32_t>(random.below(tiles.width)),
                   .y0 = static_cast<int32_t>(random.below(tiles.height))};
    rect.x1 = std::min(rect.x0 + static_cast<int32_t>(random.below(12)), static_cast<int32_t>(tiles.width) - 1);
    rect.y1 = std::min(rect.y0 + static_cast<int32_t>(random.below(12)), static_cast<int32_t>(tiles.height) - 1);
    rect.nearness = static_cast<float>(1.0 / random.uniform(3, 9));
    return rect;
}

TEST(Seams, AnswerTheSameWhateverWasAskedBefore) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed), same(seed);
        Drawing forth(smallView()), back(smallView());
        forth.draw(mixedScene(random));
        back.draw(mixedScene(same));
        std::vector<PixelRect> rects;
        for (int i = 0; i < 4000; ++i) rects.push_back(randomRect(random, forth.tiles));
        std::vector<bool> hidden(rects.size());
        for (size_t i = 0; i < rects.size(); ++i) hidden[i] = isHidden(forth.tiles, rects[i]);
        EXPECT_GT(forth.tiles.seam_pixels, 0u);
        size_t count = 0;
        for (size_t i = rects.size(); i-- > 0;) {
            ASSERT_EQ(isHidden(back.tiles, rects[i]), hidden[i]) << "seed " << seed << ", rectangle " << i;
            count += hidden[i];
        }
        EXPECT_GT(count, 100u);
        EXPECT_LT(count, 3900u);
    }
}

TEST(Seams, HideARectangleIfAndOnlyIfAllItsPixelsDo) {
    for (uint64_t seed = 11; seed <= 14; ++seed) {
        Random random(seed), same(seed);
        Drawing asked(smallView()), resolved(smallView());
        asked.draw(mixedScene(random));
        resolved.drawAndResolve(mixedScene(same));
        for (int i = 0; i < 3000; ++i) {
            const PixelRect rect = randomRect(random, asked.tiles);
            bool all = true;
            for (int32_t y = rect.y0; y <= rect.y1; ++y)
                for (int32_t x = rect.x0; x <= rect.x1; ++x)
                    all &= resolved.depth(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) > rect.nearness;
            ASSERT_EQ(isHidden(asked.tiles, rect), all) << "seed " << seed << ", rectangle " << i;
        }
    }
}

TEST(Seams, WhatMasksRefuteStaysOpen) {
    uint64_t refuted = 0;
    for (uint64_t seed = 21; seed <= 24; ++seed) {
        Random random(seed), same(seed);
        Drawing asked(smallView()), resolved(smallView());
        asked.draw(mixedScene(random));
        resolved.drawAndResolve(mixedScene(same));
        for (uint32_t tile = 0; tile < asked.tiles.stride * asked.tiles.rows; ++tile) {
            if (asked.tiles.seams[tile] == DepthTiles::kNone) continue;
            float before[64], after[64];
            readClaims(asked.tiles, tile, before);
            readClaims(resolved.tiles, tile, after);
            for (int step = 0; step < 12; ++step) {
                const float wanted = static_cast<float>(1.0 / random.uniform(3, 9));
                uint64_t open = 0;
                for (int i = 0; i < 64; ++i) open |= uint64_t{!(before[i] > wanted)} << i;
                open &= asked.tiles.seam_mask[tile];
                uint64_t sure = lookAtSeams(asked.tiles, tile, open, wanted).open;
                refuted += static_cast<uint64_t>(std::popcount(sure));
                for (; sure; sure &= sure - 1)
                    ASSERT_FALSE(after[std::countr_zero(sure)] > wanted) << "seed " << seed << ", tile " << tile;
            }
        }
    }
    EXPECT_GT(refuted, 1000u);
}

}  // namespace
}  // namespace sightline::test
