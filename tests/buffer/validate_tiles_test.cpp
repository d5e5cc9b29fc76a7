// Depth tiles that are damaged on purpose are reported.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/validate_tiles.h"

#include <gtest/gtest.h>

#include "tests/buffer/tiles_fixture.h"
#include "tests/support/debug_asserts.h"

namespace sightline::test {
namespace {

TEST(ValidateTilesDeathTest, ReportsEachKindOfDamage) {
    Random random(7);
    Drawing drawing(smallView());
    drawing.drawAndResolve({makeSheet(random, 13, 9, {-2, -1, -4}, {2, 1, -6}, 0.05f)});
    DepthTiles& tiles = drawing.tiles;
    validateTiles(tiles);
    uint32_t seam = DepthTiles::kNone, layer = DepthTiles::kNone, covered = DepthTiles::kNone;
    for (uint32_t row = 0; row < tiles.rows; ++row)
        for (uint32_t column = 0; column < tiles.columns; ++column) {
            const uint32_t tile = row * tiles.stride + column;
            if (tiles.seams[tile] != DepthTiles::kNone) seam = tile;
            if (tiles.layer[tile] > DepthTiles::kOpen) layer = tile;
            if (tiles.cover_count[tile] > 0) covered = tile;
        }
    ASSERT_NE(seam, DepthTiles::kNone);
    ASSERT_NE(layer, DepthTiles::kNone);
    ASSERT_NE(covered, DepthTiles::kNone);

    const auto expectReport = [&](const char* text, const auto& damage) {
        expectDebugAssert(text, [&] {
            damage();
            validateTiles(tiles);
        });
    };
    expectReport("width", [&] { tiles.width += 8; });
    expectReport("tried.size", [&] { tiles.tried.pop_back(); });
    expectReport("mask", [&] { tiles.layer_mask[layer] = 0; });
    expectReport("isnan", [&] { tiles.layer[layer] = std::numeric_limits<float>::quiet_NaN(); });
    expectReport("block_count", [&] { tiles.block[layer] = tiles.block_count; });
    expectReport("cover_count", [&] { tiles.cover_count[covered] = DepthTiles::kCovers + 1; });
    expectReport("planes.size", [&] { tiles.planes.clear(); });
    expectReport("seam_mask", [&] { tiles.seam_mask[seam] = 0; });
    expectReport("drawn", [&] { tiles.drawn.clear(); });
    expectReport("chunk.count", [&] { tiles.chunks[tiles.seams[seam]].count = 0; });
    expectReport("vertex_count", [&] { tiles.vertex_count = 0; });
}

TEST(ValidateTilesDeathTest, LooksAtARectangleAlone) {
    Drawing drawing(smallView());
    DepthTiles& tiles = drawing.tiles;
    tiles.layer[0] = 1.0f;
    tiles.layer_mask[0] = 0;
    tiles.block[0] = DepthTiles::kNone;
    validateTiles(tiles, {8, 0, 15, 7, 0});
    expectDebugAssert("mask", [&] { validateTiles(tiles, {7, 7, 15, 15, 0}); });
}

}  // namespace
}  // namespace sightline::test
