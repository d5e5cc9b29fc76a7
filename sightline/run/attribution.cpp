// Which occluder hides each pixel of a recorded walk's buffer: each drawn alone, and the nearest wins.
// SPDX-License-Identifier: MIT
#include "sightline/run/attribution.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace sightline::detail {
namespace {

constexpr float kFarthest = -std::numeric_limits<float>::infinity();

/// Draws the clusters of one instance into empty tiles; returns the pixels that they may touch, and the nearest of
/// their depths.
PixelRect drawAlone(const Walk& walk, const WalkRecord& record, std::span<const uint32_t> draws, DepthTiles& tiles) {
    tiles.clear(walk.screen.width, walk.screen.height);
    const PixelRect everywhere{0, 0, static_cast<int32_t>(tiles.width) - 1, static_cast<int32_t>(tiles.height) - 1,
                               std::numeric_limits<float>::infinity()};
    PixelRect region{everywhere.x1, everywhere.y1, 0, 0, kFarthest};
    for (uint32_t at : draws) {
        const WalkRecord::Draw& draw = record.draws[at];
        drawOccluder(tiles, walk.instances[draw.instance], draw.cluster, draw.box);
        const PixelRect& rect = draw.box.doubt ? everywhere : draw.box.rect;
        region = {std::min(region.x0, rect.x0), std::min(region.y0, rect.y0), std::max(region.x1, rect.x1),
                  std::max(region.y1, rect.y1), std::max(region.nearness, rect.nearness)};
    }
    return region;
}

/// Covers what can be covered of the pixels that polygons of the instance share.
void resolveTile(DepthTiles& tiles, uint32_t tile) {
    pairSeams(tiles, tile, ~tiles.coveredBits(tile));
    for (uint64_t open = tiles.seam_mask[tile] & ~tiles.coveredBits(tile); open; open &= open - 1)
        resolveSeam(tiles, tile, std::countr_zero(open), kFarthest);
}

}  // namespace

void Attribution::run(const Walk& walk, const WalkRecord& record, uint32_t draws) {
    pixels.assign(size_t{walk.screen.width} * walk.screen.height, PixelOwner());
    order.resize(draws);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return record.draws[a].instance < record.draws[b].instance; });
    for (size_t first = 0, last = 0; first < order.size(); first = last) {
        const uint32_t instance = record.draws[order[first]].instance;
        while (last < order.size() && record.draws[order[last]].instance == instance) ++last;
        const PixelRect region = drawAlone(walk, record, std::span(order).subspan(first, last - first), tiles);
        for (int32_t row = region.y0 >> 3; row <= region.y1 >> 3; ++row)
            for (int32_t column = region.x0 >> 3; column <= region.x1 >> 3; ++column) {
                const uint32_t tile = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column);
                if (tiles.form[tile] == DepthTiles::Form::kEmpty && !tiles.seam_mask[tile]) continue;
                resolveTile(tiles, tile);
                const uint64_t covered = tiles.coveredBits(tile);
                if (covered) writeOut(tiles, tile);
                for (uint64_t left = covered | tiles.seam_mask[tile]; left; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    PixelOwner& pixel = pixels[static_cast<size_t>(8 * row + (bit >> 3)) * tiles.width +
                                               static_cast<size_t>(8 * column + (bit & 7))];
                    if (!(covered >> bit & 1)) {
                        if (pixel.toucher == PixelOwner::kNone)
                            pixel.toucher = instance, pixel.touching = region.nearness;
                        continue;
                    }
                    const float nearness = tiles.depthAt(tile, bit);
                    if (pixel.owner != PixelOwner::kNone && pixel.nearness >= nearness) continue;
                    pixel.owner = instance;
                    pixel.nearness = nearness;
                }
            }
    }
}

}  // namespace sightline::detail
