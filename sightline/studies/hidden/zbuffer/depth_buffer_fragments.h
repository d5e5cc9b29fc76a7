// Fragments one by one: shaders that discard or write depth, every comparison, counts per sample, compressed tiles.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/studies/hidden/image.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer_polygon.h"
#include "sightline/studies/hidden/zbuffer/depth_settings.h"

namespace sightline::studies {

/// What all rows of tiles share. Rows can be drawn by several threads, each by one at a time.
struct DepthDraw {
    DepthBuffer& buffer;
    const DepthCodec& codec;
    const DepthSettings& settings;
    DepthComparison comparison;  ///< the one in force
    HiddenImage& image;          ///< of the buffer's size; its counters stay as they are
};

/// One thread's own.
struct DepthDrawScratch {
    HiddenCounters counters;
    std::vector<uint32_t> touched;    ///< tiles that were read or written: counted and kept compressed afterwards
    std::vector<uint8_t> is_touched;  ///< by column: 1 read, 2 written
};

/// Which fragments of a kind of shader can be tested before they are shaded, if the early test is on.
/// kWritesFarther: only if the comparison lets pass what is nearer.
bool allowsEarlyTest(const DepthSettings& settings, DepthComparison comparison, const DepthConvention& convention);

/// What is known of a range of keys that comes to a range that is there.
bool rejectsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest);
bool acceptsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest);

/// What is nearer passes, what passes is written, and nobody asks for more.
bool isPlain(const DepthDraw& draw);

/// A polygon's part in a tile.
struct TileFragments {
    const DepthPolygon& polygon;
    int32_t row, sample;  ///< of the tile's first sample
    uint64_t mask;        ///< sample 8 * j + i of the tile
    uint32_t tile;
    bool accepted;  ///< all are known to pass
};

class FragmentDrawer {
public:
    explicit FragmentDrawer(const DepthDraw& draw)
        : draw_(draw), early_(allowsEarlyTest(draw.settings, draw.comparison, draw.codec.convention)) {}

    bool countsSamples() const { return !draw_.image.generated.empty(); }
    void countGenerated(int32_t row, int32_t sample, uint64_t mask, HiddenCounters& count) const;

    /// Tests, shades and writes. True if any key was written.
    /// @param comes  keys of all samples of the tile
    bool drawTile(const TileFragments& part, const DepthKey* comes, HiddenCounters& count) const;

    /// Shows a surface at samples of a tile.
    void show(int32_t row, int32_t sample, uint64_t mask, uint32_t surface) const;

    /// Notes a tile that is about to be read or written, and makes its keys readable.
    void touch(uint32_t tile, DepthDrawScratch& scratch) const;

private:
    void countSamples(std::vector<uint16_t>& counts, const TileFragments& part, uint64_t mask) const;
    uint64_t passing(const TileFragments& part, const DepthKey* comes, uint64_t mask) const;

    const DepthDraw& draw_;
    bool early_;
};

/// After a row of tiles: compresses those that were touched and counts the bytes that they moved.
void keepTiles(const DepthDraw& draw, DepthDrawScratch& scratch);

}  // namespace sightline::studies
