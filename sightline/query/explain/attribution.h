// Which occluder hides each pixel of a recorded traversal's buffer: each drawn alone, and the nearest wins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/query/recorded_traversal.h"

namespace sightline::detail {

/// A pixel's occluder. One that no occluder covers alone, but several together, belongs to the first that touches it.
struct PixelOwner {
    static constexpr uint32_t kNone = ~0u;

    float nearness = 0;        ///< of what `owner` covers the pixel with
    float touching = 0;        ///< no point of `toucher` is nearer
    uint32_t owner = kNone;    ///< index into TraversalState::instances
    uint32_t toucher = kNone;  ///< the same

    /// Who hides the pixel from something that is hidden there, and of which no point is nearer than the given nearness.
    /// What lies behind planes, and not behind the depths of the pixel, is given to the nearest.
    uint32_t hiderOf(float depth) const {
        if (owner != kNone && nearness > depth) return owner;
        if (toucher != kNone && touching > depth) return toucher;
        return owner != kNone ? owner : toucher;
    }
};

inline bool overlaps(const PixelRect& a, const PixelRect& b) {
    return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

/// The owners of a buffer's pixels. Keeps its scratch memory from frame to frame.
struct Attribution {
    explicit Attribution(Memory* memory) : tiles(memory), pixels(memory), order(memory) {}

    DepthTiles tiles;  ///< of one occluder
    Array<PixelOwner> pixels;
    Array<uint32_t> order;  ///< the record's draws, those of an instance beside one another

    /// @param within  pixels that matter: others may be left without an owner
    void run(const RecordedTraversal& from, const PixelRect& within);
    /// All pixels.
    void run(const RecordedTraversal& from);

    const PixelOwner& at(int32_t x, int32_t y) const {
        return pixels[static_cast<size_t>(y) * tiles.width + static_cast<size_t>(x)];
    }
};

}  // namespace sightline::detail
