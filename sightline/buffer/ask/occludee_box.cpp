// An occludee's box, held against planes: what lies wholly behind an occluder's plane is hidden where that covers.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/ask/occludee_box.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sightline/base/ablate.h"
#include "sightline/base/assert.h"

namespace sightline {

void OccludeeBox::makeImage() const {
    SIGHTLINE_DEBUG_ASSERT(screen_ != nullptr);
    const Screen& screen = *std::exchange(screen_, nullptr);
    const glm::dvec3 center = 0.5 * (box_.min + box_.max), half = 0.5 * (box_.max - box_.min);
    const glm::dvec4* const rows[4] = {&screen.x, &screen.y, &screen.w, &screen.d};
    const double place[4] = {errors_.pixel_error, errors_.pixel_error, screen.perspective ? errors_.depth_error : 0.0,
                             screen.perspective ? 0.0 : errors_.depth_error};
    for (int i = 0; i < 4; ++i) {
        const glm::dvec4& row = *rows[i];
        image_.row[i][0] = row.x * center.x + row.y * center.y + row.z * center.z + row.w;
        double size = 0;
        for (int axis = 0; axis < 3; ++axis) {
            image_.row[i][axis + 1] = row[axis] * half[axis];
            size += std::abs(row[axis]) * std::max(std::abs(box_.min[axis]), std::abs(box_.max[axis]));
        }
        // Less than fifty roundings of 2^-53, those of decide() among them.
        image_.error[i] = place[i] + errors_.rounding * size + 0x1p-46 * (size + std::abs(row.w));
    }
}

bool OccludeeBox::decide(const DepthTiles& tiles, uint32_t plane) const {
    const Image& at = image();
    const BufferPlane& from = tiles.planes[plane];
    SIGHTLINE_DEBUG_ASSERT(from.error >= 0);
    const double factor[4] = {from.dx, from.dy, from.d0 - static_cast<double>(from.error), -1.0};
    double sum[4] = {}, error = 0;
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 4; ++k) sum[k] += factor[i] * at.row[i][k];
        error += std::abs(factor[i]) * at.error[i];
    }
    const double least = sum[0] - std::abs(sum[1]) - std::abs(sum[2]) - std::abs(sum[3]);
    const bool behind = !detail::kAblate.planes && least > error;  // false of a NaN
    known_[plane % kKnown] = 2 * (uint64_t{plane} + 1) + behind;
    return behind;
}

}  // namespace sightline
