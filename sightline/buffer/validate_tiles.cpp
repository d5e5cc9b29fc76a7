// Whether depth tiles are what their fields say: in debug builds, after each cluster that is drawn and each answer.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/validate_tiles.h"

#ifdef SIGHTLINE_DEBUG_ASSERTS

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

void validateDepths(const DepthTiles& tiles, uint32_t tile) {
    const float base = tiles.base[tile], layer = tiles.layer[tile];
    SIGHTLINE_DEBUG_ASSERT(!std::isnan(base) && !std::isnan(layer));
    if (base > DepthTiles::kOpen)
        SIGHTLINE_DEBUG_ASSERT(tiles.plane[tile] == DepthTiles::kNone || tiles.plane[tile] < tiles.planes.size());
    if (layer == DepthTiles::kOpen) return;
    const uint64_t mask = tiles.layer_mask[tile];
    // Small polygons that only touch a tile may leave a layer without pixels in masked detail.
    SIGHTLINE_DEBUG_ASSERT(mask != 0 || tiles.detail == Detail::kMasked);
    if (tiles.block[tile] == DepthTiles::kNone) return;
    SIGHTLINE_DEBUG_ASSERT(tiles.block[tile] < tiles.block_count);
    const float* const block = tiles.blocks.data() + 64 * size_t{tiles.block[tile]};
    float greatest = DepthTiles::kOpen;
    for (uint32_t i = 0; i < 64; ++i) {
        SIGHTLINE_DEBUG_ASSERT((block[i] > DepthTiles::kOpen) == (mask >> i & 1));
        greatest = std::max(greatest, block[i]);
    }
    SIGHTLINE_DEBUG_ASSERT(greatest == layer);
}

void validateCovers(const DepthTiles& tiles, uint32_t tile) {
    SIGHTLINE_DEBUG_ASSERT(tiles.cover_count[tile] <= DepthTiles::kCovers);
    const TileCover* const covers = tiles.covers.data() + DepthTiles::kCovers * size_t{tile};
    for (uint32_t i = 0; i < tiles.cover_count[tile]; ++i) {
        SIGHTLINE_DEBUG_ASSERT(covers[i].mask != 0 && !covers[i].planes.empty());
        bool ended = false;
        for (const uint32_t plane : covers[i].planes.plane) {
            SIGHTLINE_DEBUG_ASSERT(plane == PlaneSet::kNone || (!ended && plane < tiles.planes.size()));
            ended = plane == PlaneSet::kNone;
        }
    }
}

/// Checks a chunk of a tile's entries.
void validateChunk(const DepthTiles& tiles, uint32_t tile, uint32_t index) {
    SIGHTLINE_DEBUG_ASSERT(index < tiles.chunks.size());
    const SeamChunk& chunk = tiles.chunks[index];
    SIGHTLINE_DEBUG_ASSERT(chunk.count > 0 && chunk.count <= SeamChunk::kMost);
    // Older chunks are full and have smaller numbers.
    SIGHTLINE_DEBUG_ASSERT(chunk.next == DepthTiles::kNone || chunk.next < index);
    SIGHTLINE_DEBUG_ASSERT(chunk.before ==
                           (chunk.next == DepthTiles::kNone ? 0 : tiles.chunks[chunk.next].before + SeamChunk::kMost));
    SIGHTLINE_DEBUG_ASSERT(chunk.next == DepthTiles::kNone || tiles.chunks[chunk.next].count == SeamChunk::kMost);
    for (uint32_t i = 0; i < chunk.count; ++i) {
        const SeamEntry entry = chunk.entry(i);
        SIGHTLINE_DEBUG_ASSERT(entry.mask != 0 && (entry.mask & ~tiles.seam_mask[tile]) == 0);
        SIGHTLINE_DEBUG_ASSERT(!std::isnan(entry.nearest) && entry.drawn() < tiles.drawn.size());
        const DrawnCluster& drawn = tiles.drawn[entry.drawn()];
        const OccluderCluster& cluster = drawn.occluder->clusters[drawn.cluster];
        SIGHTLINE_DEBUG_ASSERT(entry.polygon() == SeamEntry::kAllPolygons ||
                               entry.polygon() < cluster.polygon_count + cluster.ring_count);
    }
}

void validateSeams(const DepthTiles& tiles, uint32_t tile, bool all) {
    const uint32_t newest = tiles.seams[tile];
    if (newest == DepthTiles::kNone) return;
    validateChunk(tiles, tile, newest);
    SIGHTLINE_DEBUG_ASSERT((tiles.tried[tile] & ~tiles.seam_mask[tile]) == 0);
    SIGHTLINE_DEBUG_ASSERT(tiles.lid_mask[tile] == 0 || !std::isnan(tiles.lid[tile]));
    for (uint32_t at = newest; all && at != DepthTiles::kNone; at = tiles.chunks[at].next)
        validateChunk(tiles, tile, at);
}

void validateTile(const DepthTiles& tiles, uint32_t tile, bool all) {
    validateDepths(tiles, tile);
    validateCovers(tiles, tile);
    validateSeams(tiles, tile, all);
}

void validateSizes(const DepthTiles& tiles) {
    SIGHTLINE_DEBUG_ASSERT(tiles.width == 8 * tiles.columns && tiles.height == 8 * tiles.rows);
    SIGHTLINE_DEBUG_ASSERT(tiles.stride % 16 == 0 && tiles.columns <= tiles.stride);
    SIGHTLINE_DEBUG_ASSERT(tiles.first_column <= tiles.end_column && tiles.end_column <= tiles.columns);
    const size_t count = size_t{tiles.stride} * tiles.rows;
    SIGHTLINE_DEBUG_ASSERT(tiles.base.size() >= count && tiles.layer.size() == tiles.base.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.seams.size() == tiles.base.size() && tiles.cover_count.size() == tiles.base.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.plane.size() >= tiles.base.size() && tiles.layer_mask.size() == tiles.plane.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.block.size() == tiles.plane.size() && tiles.seam_mask.size() == tiles.plane.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.tried.size() == tiles.plane.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.lid.size() == tiles.plane.size() && tiles.lid_mask.size() == tiles.plane.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.covers.size() == DepthTiles::kCovers * tiles.plane.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.blocks.size() >= 64 * size_t{tiles.block_count});
    SIGHTLINE_DEBUG_ASSERT(tiles.px.size() >= tiles.vertex_count && tiles.px.size() == tiles.py.size() &&
                           tiles.px.size() == tiles.pd.size());
    SIGHTLINE_DEBUG_ASSERT(tiles.gap >= 0);
}

void validateDrawn(const DepthTiles& tiles) {
    for (const DrawnCluster& drawn : tiles.drawn) {
        SIGHTLINE_DEBUG_ASSERT(drawn.occluder && drawn.transform && drawn.cluster < drawn.occluder->clusters.size());
        const OccluderCluster& cluster = drawn.occluder->clusters[drawn.cluster];
        SIGHTLINE_DEBUG_ASSERT(drawn.first_vertex == DepthTiles::kNone ||
                               size_t{drawn.first_vertex} + cluster.vertex_count <= tiles.vertex_count);
        SIGHTLINE_DEBUG_ASSERT(drawn.object < tiles.objects.size());
        SIGHTLINE_DEBUG_ASSERT(drawn.made == DepthTiles::kNone ||
                               size_t{drawn.made} + cluster.polygon_count <= tiles.made.size());
        SIGHTLINE_DEBUG_ASSERT(drawn.boxes == DepthTiles::kNone ||
                               drawn.boxes + (cluster.polygon_count + 15) / 16 * size_t{64} <= tiles.boxes.size());
        SIGHTLINE_DEBUG_ASSERT(drawn.position_error >= 0 && drawn.depth_error >= 0);
    }
}

void validatePolygons(const DepthTiles& tiles) {
    for (const BufferPlane& plane : tiles.planes) {
        SIGHTLINE_DEBUG_ASSERT(std::isfinite(plane.d0) && std::isfinite(plane.dx) && std::isfinite(plane.dy));
        SIGHTLINE_DEBUG_ASSERT(!std::isnan(plane.floor) && plane.error >= 0);
    }
    for (const SeamPolygon& polygon : tiles.polygons) {
        SIGHTLINE_DEBUG_ASSERT(polygon.drawn < tiles.drawn.size());
        SIGHTLINE_DEBUG_ASSERT(polygon.corners == 3 || polygon.corners == 4);
        SIGHTLINE_DEBUG_ASSERT(polygon.clipped == SeamPolygon::kWhole || polygon.clipped < tiles.clipped.size());
        SIGHTLINE_DEBUG_ASSERT(polygon.plane == DepthTiles::kNone || polygon.plane < tiles.planes.size());
        SIGHTLINE_DEBUG_ASSERT(polygon.open == 0 || polygon.clipped != SeamPolygon::kWhole);
    }
    for (const uint32_t made : tiles.made)
        SIGHTLINE_DEBUG_ASSERT(made == DepthTiles::kNone || made / 4 + made % 4 <= tiles.polygons.size());
}

}  // namespace

void validateTiles(const DepthTiles& tiles) {
    validateSizes(tiles);
    validateDrawn(tiles);
    validatePolygons(tiles);
    for (uint32_t row = 0; row < tiles.rows; ++row)
        for (uint32_t column = tiles.first_column; column < tiles.end_column; ++column)
            validateTile(tiles, row * tiles.stride + column, true);
}

void validateTiles(const DepthTiles& tiles, const PixelRect& rect) {
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.x0 && static_cast<uint32_t>(rect.x1 + 1) <= tiles.width);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.y0 && static_cast<uint32_t>(rect.y1 + 1) <= tiles.height);
    PixelRect kept = rect;
    if (!tiles.clip(kept)) return;
    for (int32_t row = kept.y0 >> 3; row <= kept.y1 >> 3; ++row)
        for (int32_t column = kept.x0 >> 3; column <= kept.x1 >> 3; ++column)
            validateTile(tiles, static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column), false);
}

}  // namespace sightline

#endif
