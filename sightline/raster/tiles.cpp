// The occlusion buffer: tiles of 8x8 pixels with a coverage mask, a depth per pixel, and seams kept aside.
// SPDX-License-Identifier: MIT
#include "sightline/raster/tiles.h"

#include <algorithm>
#include <limits>

namespace sightline {

void DepthTiles::clear(uint32_t new_width, uint32_t new_height) {
    width = new_width;
    height = new_height;
    columns = (width + 7) / 8;
    rows = (height + 7) / 8;
    const size_t count = size_t{columns} * rows;
    if (depth.size() < 64 * count) depth.resize(64 * count);
    Tile empty;
    empty.farthest = -std::numeric_limits<float>::infinity();
    tiles.assign(count, empty);
    px.clear();
    py.clear();
    pd.clear();
    drawn.clear();
    clipped.clear();
    triangles.clear();
    entries.clear();
    seam_pixels = 0;
}

}  // namespace sightline
