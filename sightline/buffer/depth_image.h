// The depth that every pixel of the occlusion buffer claims, as one image: for pictures, and to see what went wrong.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sightline/buffer/tiles.h"

namespace sightline {

/// Reads the whole buffer, or the columns that matter, row by row, the lowest row first. A pixel with depth d hides
/// what is farther than d at all of its points: isHidden() of that pixel alone is true for nearnesses below d, else
/// false.
/// @param seams     kResolve: all pixels that polygons share are resolved first, and stay so
/// @param nearness  [size: width * height]
/// @param covered   1 where the pixel claims a depth, else 0; may be empty  [size: width * height]
/// @param open      the nearness written where it claims none
void readDepthImage(DepthTiles& tiles, Seams seams, std::span<float> nearness, std::span<uint8_t> covered = {},
                    float open = -std::numeric_limits<float>::infinity());

}  // namespace sightline
