// Lossless compression of a tile of depths: offsets from two depths, planes, or second differences.
// SPDX-License-Identifier: MIT
//
// Jon Hasselgren, Tomas Akenine-Möller. Efficient Depth Buffer Compression. 2006.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

/// How a tile is kept. Each has its escape: where a tile does not suit it, it gives no answer, and kRaw always does.
enum class TileCoding : uint8_t {
    kRaw,              ///< the keys as they are
    kOffset,           ///< the least and the greatest key; per sample a bit that selects one, and the distance from it
    kPlane,            ///< a plane through the tile and what each sample differs from it
    kTwoPlanes,        ///< two of them and a bit that selects one: an edge passes through
    kDifferences,      ///< a corner, its slopes, and differences of differences (DDPCM), from the lowest row upward
    kDifferencesDown,  ///< the same from the highest row downward
};
inline constexpr int kTileCodings = 6;

/// The greatest size of a compressed tile [bytes]
inline constexpr uint32_t kCompressedLimit = 264;

/// By the coding that takes the fewest bytes.
/// @param keys  [size: 64], row by row
/// @param out   [size: kCompressedLimit]
/// @returns the bytes written
uint32_t compressTile(const DepthKey* keys, uint8_t* out);

/// By one coding.
/// @returns the bytes written, or 0 if the tile does not suit it: it would take more than kRaw
uint32_t compressTileAs(TileCoding coding, const DepthKey* keys, uint8_t* out);

/// The same keys, bit for bit.
/// @param packed  what compressTile() wrote
/// @param keys    [size: 64]
void decompressTile(std::span<const uint8_t> packed, DepthKey* keys);

inline TileCoding codingOf(std::span<const uint8_t> packed) { return static_cast<TileCoding>(packed[0] & 7); }

}  // namespace sightline::studies
