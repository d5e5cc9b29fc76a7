// The pixels that an object was asked at, and how near it may be in each: what hides these hides the object.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "sightline/query/recorded_traversal.h"

namespace sightline::detail {

/// Keeps its scratch memory from object to object.
struct AskedPixels {
    static constexpr float kNotAsked = -std::numeric_limits<float>::infinity();

    explicit AskedPixels(Memory* memory) : nearness(memory), empty(memory) {}

    PixelRect rect;                  ///< holds them all
    Array<float> nearness;           ///< per pixel of the rectangle; kNotAsked where nothing of the object can be
    std::optional<OccludeeBox> box;  ///< that was held against planes
    DepthTiles empty;                ///< in which outlines are drawn

    /// @param x,y  inside `rect`
    float at(int32_t x, int32_t y) const {
        return nearness[static_cast<size_t>(y - rect.y0) * static_cast<size_t>(rect.x1 - rect.x0 + 1) +
                        static_cast<size_t>(x - rect.x0)];
    }

    /// All of a rectangle, with its depth.
    void run(const PixelRect& around);
    /// Those of an object by one of the looks; its rectangle where a look finds no bounds.
    /// @param place   in the hierarchy of the world that was traversed
    /// @param around  the rectangle of its box, if that has one
    /// @returns false if it finds none
    bool run(const RecordedTraversal& from, uint32_t place, Look look, const PixelRect* around);
};

}  // namespace sightline::detail
