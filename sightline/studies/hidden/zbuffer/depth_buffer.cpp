// A depth buffer in tiles: what each tile holds, cleared without being touched, and the bounds that reject by tiles.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer.h"

#include <algorithm>

namespace sightline::studies {

void DepthBuffer::resize(uint32_t new_width, uint32_t new_height) {
    width = new_width;
    height = new_height;
    columns = (width + kTile - 1) / kTile;
    rows = (height + kTile - 1) / kTile;
    stride = (columns + 15) / 16 * 16;
    const size_t size = size_t{kTileSamples} * stride * rows;
    if (size <= allocated) return;
    keys = std::make_unique_for_overwrite<DepthKey[]>(size);
    allocated = size;
}

void DepthBuffer::clear(DepthKey key, bool fast) {
    const size_t tiles = size_t{stride} * rows;
    clear_key = key;
    state.assign(tiles, fast ? State::kCleared : State::kRaw);
    stored_bytes.resize(tiles);
    least.assign(tiles, key);
    greatest.assign(tiles, key);
    loose.assign(tiles, 0);
    if (!fast) std::fill(keys.get(), keys.get() + kTileSamples * tiles, key);
}

DepthKey DepthBuffer::at(int32_t row, int32_t sample) const {
    const uint32_t r = static_cast<uint32_t>(row), s = static_cast<uint32_t>(sample);
    const uint32_t tile = r / kTile * stride + s / kTile;
    if (state[tile] == State::kCleared) return clear_key;
    return tileKeys(tile)[r % kTile * kTile + s % kTile];
}

}  // namespace sightline::studies
