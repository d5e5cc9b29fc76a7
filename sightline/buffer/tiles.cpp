// The occlusion buffer: tiles of 8x8 pixels, each a depth for all of it and one nearer layer; seams are kept aside.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/tiles.h"

#include <utility>

#include "sightline/base/assert.h"

namespace sightline {

void DepthTiles::clear(uint32_t new_width, uint32_t new_height, Detail new_detail) {
    SIGHTLINE_DEBUG_ASSERT(new_width % 8 == 0 && new_height % 8 == 0);
    width = new_width;
    height = new_height;
    columns = (width + 7) / 8;
    rows = (height + 7) / 8;
    stride = (columns + 15) / 16 * 16;
    first_column = 0;
    end_column = columns;
    detail = new_detail;
    const size_t count = size_t{stride} * rows + kBeyond;
    base.assign(count, kOpen);
    layer.assign(count, kOpen);
    seams.assign(count, kNone);
    cover_count.assign(count, 0);
    if (plane.size() < count) {  // these are read only where the ones above say that they were written
        plane.resize(count);
        layer_mask.resize(count);
        block.resize(count);
        seam_mask.resize(count);
        tried.resize(count);
        lid.resize(count);
        lid_mask.resize(count);
        covers.resize(kCovers * count);
    }
    planes.clear();
    block_count = 0;
    vertex_count = 0;
    drawn.clear();
    objects.clear();
    clipped.clear();
    polygons.clear();
    made.clear();
    boxes.clear();
    chunks.clear();
    seam_pixels = closed_gaps = 0;
    gap = 0;
}

void DepthTiles::keepColumns(uint32_t first, uint32_t end) {
    SIGHTLINE_DEBUG_ASSERT(first <= end && end <= columns);
    SIGHTLINE_DEBUG_ASSERT(first_column == 0 && end_column == columns);
    first_column = first;
    end_column = end;
    for (size_t row = 0; row < rows; ++row)
        for (const auto& [from, to] : {std::pair(0u, first), std::pair(end, columns)}) {
            const size_t at = row * stride + from;
            std::fill_n(base.data() + at, to - from, std::numeric_limits<float>::infinity());
            std::fill_n(plane.data() + at, to - from, kNone);
        }
}

}  // namespace sightline
