// A depth buffer in tiles: what each tile holds, cleared without being touched, and the bounds that reject by tiles.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

/// Tiles of 8x8 samples, row by row, row 0 at the bottom; a tile's samples lie together, row by row.
///
/// For each tile two bounds are kept, least <= each of its keys <= greatest, whatever the comparison: what comes can
/// only widen them. Where it could matter, they are made tight again by a look at the keys. So a comparison that
/// changes in the middle of a frame finds bounds that hold.
struct DepthBuffer {
    static constexpr uint32_t kTile = 8, kTileSamples = 64;

    enum class State : uint8_t {
        kCleared,    ///< all samples have clear_key; keys are not
        kRaw,        ///< keys are
        kCompressed  ///< the place of its keys holds them compressed: compressTile()
    };

    DepthBuffer() = default;
    DepthBuffer(uint32_t width_, uint32_t height_, DepthKey key, bool fast = true) {
        resize(width_, height_);
        clear(key, fast);
    }

    /// To be followed by clear(). Allocates if it grows.
    void resize(uint32_t width, uint32_t height);

    /// @param fast  by the tiles' states alone; otherwise all keys are written
    void clear(DepthKey key, bool fast = true);

    /// To be called when the comparison changes: bounds that were widened for one direction alone are looked at again
    /// before they decide.
    void noteComparison() { std::fill(loose.begin(), loose.end(), uint8_t{1}); }

    DepthKey* tileKeys(uint32_t tile) { return keys.get() + size_t{tile} * kTileSamples; }
    const DepthKey* tileKeys(uint32_t tile) const { return keys.get() + size_t{tile} * kTileSamples; }
    /// Of a tile in any state but kCompressed.
    DepthKey at(int32_t row, int32_t sample) const;

    uint32_t width = 0, height = 0;  ///< [samples]
    uint32_t columns = 0, rows = 0;  ///< [tiles]
    uint32_t stride = 0;  ///< tiles from a row to the next: a multiple of 16, so that bounds can be read many at once
    DepthKey clear_key = 0;
    size_t allocated = 0;              ///< keys
    std::unique_ptr<DepthKey[]> keys;  ///< [size: 64 * stride * rows]
    std::vector<State> state;          ///< [size: stride * rows]
    std::vector<DepthKey> least, greatest;
    std::vector<uint8_t> loose;          ///< 1: keys have changed since the bounds were tight
    std::vector<uint16_t> stored_bytes;  ///< of tiles in state kCompressed
};

}  // namespace sightline::studies
