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
    stride = (columns + 7) / 8 * 8;
    constexpr float kOpen = -std::numeric_limits<float>::infinity();
    const size_t count = size_t{stride} * rows;
    farthest.assign(count, kOpen);
    nearest.assign(count, kOpen);
    form.assign(count, Form::kEmpty);
    tried.assign(count, 0);
    seams.assign(count, kNone);
    seam_mask.assign(count, 0);
    paired.assign(count, kNone);
    paired_mask.assign(count, 0);
    if (covered.size() < count) {  // these are read only where the form says that they were written
        for (Array<float>* plane : {&plane_d, &plane_dx, &plane_dy, &plane_floor}) plane->resize(count);
        covered.resize(count);
        depth.resize(64 * count);
    }
    px.clear();
    py.clear();
    pd.clear();
    drawn.clear();
    clipped.clear();
    polygons.clear();
    entries.clear();
    seam_pixels = 0;
}

}  // namespace sightline
