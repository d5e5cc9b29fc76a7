// Which pixels of those asked about the depth tiles leave open, and the one that lies deepest among them.
// SPDX-License-Identifier: MIT
//
// Gunilla Borgefors. Distance Transformations in Digital Images. 1986.
#pragma once

#include <cstdint>

#include "sightline/query/explain/asked_pixels.h"

namespace sightline::detail {

/// What it needs stays from rectangle to rectangle.
struct OpenPixels {
    explicit OpenPixels(Memory* memory) : depth(memory) {}

    uint64_t pixels = 0, open = 0;  ///< asked about, and open of these
    int32_t x = 0, y = 0;   ///< of the open pixels one that is farthest, in steps along rows and columns, from those
                            ///< that are not, nearest to the middle; the rectangle's first if none is open
    bool covered = false;   ///< that pixel is covered, but not in front of the rectangle
    Array<uint32_t> depth;  ///< per pixel of the rectangle: steps to the nearest that is not open

    /// Each pixel is asked as isHidden() asks, in its order.
    void run(DepthTiles& tiles, const AskedPixels& asked);
};

}  // namespace sightline::detail
