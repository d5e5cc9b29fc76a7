// What was asked of the depth tiles, in order, and what they answered: for recordings of a frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

#include "sightline/buffer/tiles.h"

namespace sightline {

/// Filled while DepthTiles::log points to it. Clearing the tiles leaves it as it is.
struct TileLog {
    enum class Call : uint8_t { kDraw, kRect, kTile };

    /// A call of isHidden().
    struct RectTest {
        PixelRect rect;
        Seams seams = Seams::kResolve;
        bool hidden = false;
    };
    /// A call of openPixels(). Its nearnesses are the next ones in `nearest`, one per bit of the window.
    struct TileTest {
        uint32_t tile = 0;
        Seams seams = Seams::kResolve;
        uint64_t window = 0, open = 0;
    };

    Array<Call> calls;  ///< every call in order; whoever draws notes what was drawn
    Array<RectTest> rects;
    Array<TileTest> tiles;
    Array<float> nearest;

    explicit TileLog(Memory* memory = defaultMemory()) : calls(memory), rects(memory), tiles(memory), nearest(memory) {}

    void clear() {
        calls.clear();
        rects.clear();
        tiles.clear();
        nearest.clear();
    }
    void noteDraw() { calls.push_back(Call::kDraw); }
    void note(const PixelRect& rect, Seams seams, bool hidden) {
        calls.push_back(Call::kRect);
        rects.push_back({rect, seams, hidden});
    }
    void note(uint32_t tile, uint64_t window, const float (&at)[64], Seams seams, uint64_t open) {
        calls.push_back(Call::kTile);
        tiles.push_back({tile, seams, window, open});
        for (uint64_t left = window; left; left &= left - 1) nearest.push_back(at[std::countr_zero(left)]);
    }
};

}  // namespace sightline
