// Triangles by the cells of a grid that their boxes meet, so that those near something are found.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/math/box.h"

namespace sightline {

/// A grid over a region. What lies outside counts to the cells at its border.
class TriangleGrid {
public:
    /// @param cells  about how many there are to be  [limit: >= 1]
    TriangleGrid(const Box3f& region, size_t cells);

    void add(uint32_t triangle, const Box3f& box);

    /// Calls `each` with triangles whose boxes may meet the given one; with some several times. Stops if it returns
    /// false.
    template <class Each>
    void near(const Box3f& box, Each each) const {
        const Range range = rangeOf(box);
        for (uint32_t z = range.low[2]; z <= range.high[2]; ++z)
            for (uint32_t y = range.low[1]; y <= range.high[1]; ++y)
                for (uint32_t x = range.low[0]; x <= range.high[0]; ++x)
                    for (uint32_t at = first_[cellOf(x, y, z)]; at != kNone; at = entries_[at].next)
                        if (!each(entries_[at].triangle)) return;
    }

private:
    static constexpr uint32_t kNone = ~uint32_t{0};
    struct Range {
        uint32_t low[3], high[3];
    };
    struct Entry {
        uint32_t triangle, next;
    };

    Range rangeOf(const Box3f& box) const;
    size_t cellOf(uint32_t x, uint32_t y, uint32_t z) const { return (size_t{z} * size_[1] + y) * size_[0] + x; }

    glm::vec3 origin_, scale_;
    uint32_t size_[3];
    std::vector<uint32_t> first_;  ///< per cell, of entries_
    std::vector<Entry> entries_;
};

}  // namespace sightline
