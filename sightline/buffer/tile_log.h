// What was asked of the depth tiles, in order, and what they answered: for recordings of a frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"

namespace sightline {

/// Filled while DepthTiles::log points to it. Clearing the tiles leaves it as it is.
struct TileLog {
    enum class Call : uint8_t { kDraw, kRect, kTile };
    static constexpr uint32_t kNoBox = ~0u;

    /// A call of isHidden().
    struct RectTest {
        PixelRect rect;
        uint32_t box = kNoBox;  ///< index into `boxes`
        Seams seams = Seams::kResolve;
        bool hidden = false;
    };
    /// A call of openPixels(). Its nearnesses are the next ones in `nearest`, one per bit of the window.
    struct TileTest {
        uint32_t tile = 0;
        uint32_t box = kNoBox;  ///< index into `boxes`
        Seams seams = Seams::kResolve;
        uint64_t window = 0, open = 0;
    };

    Array<Call> calls;  ///< every call in order; whoever draws notes what was drawn
    Array<RectTest> rects;
    Array<TileTest> tiles;
    Array<float> nearest;
    Array<OccludeeBox::Image> boxes;  ///< what was asked about

    explicit TileLog(Memory* memory = defaultMemory())
        : calls(memory), rects(memory), tiles(memory), nearest(memory), boxes(memory) {}

    void clear() {
        calls.clear();
        rects.clear();
        tiles.clear();
        nearest.clear();
        boxes.clear();
    }
    void noteDraw() { calls.push_back(Call::kDraw); }
    void note(const PixelRect& rect, Seams seams, const OccludeeBox* box, bool hidden) {
        calls.push_back(Call::kRect);
        rects.push_back({rect, indexOf(box), seams, hidden});
    }
    void note(uint32_t tile, uint64_t window, const float (&at)[64], Seams seams, const OccludeeBox* box,
              uint64_t open) {
        SIGHTLINE_DEBUG_ASSERT((open & ~window) == 0);
        calls.push_back(Call::kTile);
        tiles.push_back({tile, indexOf(box), seams, window, open});
        for (uint64_t left = window; left; left &= left - 1) nearest.push_back(at[std::countr_zero(left)]);
    }

private:
    /// One box is mostly asked about several times in a row.
    uint32_t indexOf(const OccludeeBox* box) {
        if (!box) return kNoBox;
        const OccludeeBox::Image& image = box->image();
        if (boxes.empty() || std::memcmp(&boxes.back(), &image, sizeof image) != 0) boxes.push_back(image);
        return static_cast<uint32_t>(boxes.size() - 1);
    }
};

}  // namespace sightline
