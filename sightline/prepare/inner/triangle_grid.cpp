// Triangles by the cells of a grid that their boxes meet, so that those near something are found.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/triangle_grid.h"

#include <algorithm>
#include <cmath>

namespace sightline {

TriangleGrid::TriangleGrid(const Box3f& region, size_t cells) : origin_(region.min) {
    constexpr double kMost = 512;  // along an axis
    const glm::dvec3 size = glm::max(glm::dvec3(region.max) - glm::dvec3(region.min), glm::dvec3(0.0));
    const double longest = std::max({size.x, size.y, size.z, 1e-30});
    // Surfaces have as many cells along each axis as the square root of what they fill.
    const double along = std::clamp(std::sqrt(static_cast<double>(cells)), 1.0, kMost);
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::clamp(std::floor(along * size[axis] / longest), 1.0, kMost);
        size_[axis] = static_cast<uint32_t>(count);
        scale_[axis] = static_cast<float>(count / std::max(size[axis], 1e-6 * longest));
        if (!std::isfinite(scale_[axis])) scale_[axis] = 0;
    }
    while (size_t{size_[0]} * size_[1] * size_[2] > 4 * cells + 64) {
        for (int axis = 0; axis < 3; ++axis) {
            if (size_[axis] == 1) continue;
            size_[axis] = (size_[axis] + 1) / 2;
            scale_[axis] *= 0.5f;
        }
    }
    first_.assign(size_t{size_[0]} * size_[1] * size_[2], kNone);
}

TriangleGrid::Range TriangleGrid::rangeOf(const Box3f& box) const {
    Range range;
    for (int axis = 0; axis < 3; ++axis) {
        // The same function of a bound for what is added and for what is asked, and it never falls: boxes that meet
        // have a cell in common.
        const auto cell = [&](float at) {
            const float place = (at - origin_[axis]) * scale_[axis];
            const float last = static_cast<float>(size_[axis] - 1);
            return static_cast<uint32_t>(place > 0 ? std::min(place, last) : 0.0f);
        };
        range.low[axis] = cell(box.min[axis]);
        range.high[axis] = cell(box.max[axis]);
    }
    return range;
}

void TriangleGrid::add(uint32_t triangle, const Box3f& box) {
    const Range range = rangeOf(box);
    for (uint32_t z = range.low[2]; z <= range.high[2]; ++z)
        for (uint32_t y = range.low[1]; y <= range.high[1]; ++y)
            for (uint32_t x = range.low[0]; x <= range.high[0]; ++x) {
                uint32_t& first = first_[cellOf(x, y, z)];
                entries_.push_back({triangle, first});
                first = static_cast<uint32_t>(entries_.size() - 1);
            }
}

}  // namespace sightline
