// Which occluder hides each pixel of a recorded traversal's buffer: each drawn alone, and the nearest wins.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/attribution.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace sightline::detail {
namespace {

constexpr float kFarthest = -std::numeric_limits<float>::infinity();

/// Draws the clusters of one instance into empty tiles; returns the pixels that they may touch, and the nearest of
/// their depths.
PixelRect drawAlone(const RecordedTraversal& from, std::span<const uint32_t> draws, DepthTiles& tiles) {
    tiles.clear(from.frame.screen.width, from.frame.screen.height);
    tiles.gap = from.state.tiles.gap;
    const PixelRect everywhere{0, 0, static_cast<int32_t>(tiles.width) - 1, static_cast<int32_t>(tiles.height) - 1,
                               std::numeric_limits<float>::infinity()};
    PixelRect region{everywhere.x1, everywhere.y1, 0, 0, kFarthest};
    for (uint32_t at : draws) {
        const TraversalRecord::Draw& draw = from.record.draws[at];
        drawOccluder(tiles, from.state.instances[draw.instance], draw.cluster, draw.box);
        const PixelRect& rect = draw.box.doubt ? everywhere : draw.box.rect;
        region = {std::min(region.x0, rect.x0), std::min(region.y0, rect.y0), std::max(region.x1, rect.x1),
                  std::max(region.y1, rect.y1), std::max(region.nearness, rect.nearness)};
    }
    return region;
}

/// Covers what can be covered of the pixels that polygons of the instance share.
void resolveTile(DepthTiles& tiles, uint32_t tile, uint64_t window) {
    for (uint64_t open = window & tiles.seamBits(tile) & ~tiles.coveredBits(tile); open; open &= open - 1)
        resolveSeam(tiles, tile, std::countr_zero(open), kFarthest);
}

/// Bits of a tile's pixels that a rectangle holds.
uint64_t windowOf(const PixelRect& rect, int32_t column, int32_t row) {
    uint64_t bits = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const int32_t px = 8 * column + x, py = 8 * row + y;
            if (px >= rect.x0 && px <= rect.x1 && py >= rect.y0 && py <= rect.y1) bits |= uint64_t{1} << (8 * y + x);
        }
    return bits;
}

/// Gives an instance the pixels of a tile that it is the nearest to cover.
void ownTile(Attribution& owners, int32_t column, int32_t row, uint32_t instance, float nearest, uint64_t window) {
    DepthTiles& tiles = owners.tiles;
    const uint32_t tile = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column);
    if (!tiles.coveredBits(tile) && !tiles.seamBits(tile)) return;
    resolveTile(tiles, tile, window);
    const uint64_t covered = tiles.coveredBits(tile);
    float claims[64];
    readClaims(tiles, tile, claims);
    for (uint64_t left = window & (covered | tiles.seamBits(tile)); left; left &= left - 1) {
        const int bit = std::countr_zero(left);
        PixelOwner& pixel = owners.pixels[static_cast<size_t>(8 * row + (bit >> 3)) * tiles.width +
                                          static_cast<size_t>(8 * column + (bit & 7))];
        if (!(covered >> bit & 1)) {
            if (pixel.toucher == PixelOwner::kNone) pixel.toucher = instance, pixel.touching = nearest;
            continue;
        }
        const float nearness = claims[bit];
        if (pixel.owner != PixelOwner::kNone && pixel.nearness >= nearness) continue;
        pixel.owner = instance;
        pixel.nearness = nearness;
    }
}

}  // namespace

void Attribution::run(const RecordedTraversal& from) {
    run(from, {0, 0, static_cast<int32_t>(from.frame.screen.width) - 1,
               static_cast<int32_t>(from.frame.screen.height) - 1, 0});
}

void Attribution::run(const RecordedTraversal& from, const PixelRect& within) {
    pixels.assign(size_t{from.frame.screen.width} * from.frame.screen.height, PixelOwner());
    order.clear();
    for (uint32_t at = 0; at < from.record.draws.size(); ++at)
        if (from.record.draws[at].box.doubt || overlaps(from.record.draws[at].box.rect, within)) order.push_back(at);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) {  // std::stable_sort would pass the memory hook by
                  const uint32_t one = from.record.draws[a].instance, other = from.record.draws[b].instance;
                  return one != other ? one < other : a < b;
              });
    for (size_t first = 0, last = 0; first < order.size(); first = last) {
        const uint32_t instance = from.record.draws[order[first]].instance;
        while (last < order.size() && from.record.draws[order[last]].instance == instance) ++last;
        PixelRect region = drawAlone(from, std::span(order).subspan(first, last - first), tiles);
        region = {std::max(region.x0, within.x0), std::max(region.y0, within.y0), std::min(region.x1, within.x1),
                  std::min(region.y1, within.y1), region.nearness};
        for (int32_t row = region.y0 >> 3; row <= region.y1 >> 3; ++row)
            for (int32_t column = region.x0 >> 3; column <= region.x1 >> 3; ++column)
                ownTile(*this, column, row, instance, region.nearness, windowOf(region, column, row));
    }
}

}  // namespace sightline::detail
