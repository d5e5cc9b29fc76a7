// Whether depth tiles are what their fields say: in debug builds, after each cluster that is drawn and each answer.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/tiles.h"

namespace sightline {

#ifdef SIGHTLINE_DEBUG_ASSERTS
/// Asserts what the comments of DepthTiles state. O(tiles + all that seams need).
void validateTiles(const DepthTiles& tiles);
/// The same of the tiles of a rectangle inside the buffer alone, and of the newest entries of their seams. O(those tiles).
void validateTiles(const DepthTiles& tiles, const PixelRect& rect);
#else
inline void validateTiles(const DepthTiles&) {}
inline void validateTiles(const DepthTiles&, const PixelRect&) {}
#endif

}  // namespace sightline
