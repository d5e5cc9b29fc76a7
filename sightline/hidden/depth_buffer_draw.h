// Draws polygons into one row of a depth buffer's tiles: coverage, hierarchical rejection, depth test.
// SPDX-License-Identifier: MIT
//
// Juan Pineda. A Parallel Algorithm for Polygon Rasterization. 1988. (Samples by tiles.)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/hidden/depth_buffer.h"
#include "sightline/hidden/depth_buffer_polygon.h"
#include "sightline/hidden/depth_settings.h"
#include "sightline/hidden/image.h"

namespace sightline {

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

/// Draws those polygons of the batches that meet a row of tiles, in order. Covers exactly the samples of
/// scanPolygon() (or scanHomogeneous()); a fragment that the test lets pass writes its depth and its surface. The same
/// bits on every instruction set.
void drawTileRow(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
                 DepthDrawScratch& scratch);

/// Which fragments of a kind of shader can be tested before they are shaded, if the early test is on.
/// kWritesFarther: only if the comparison lets pass what is nearer.
bool allowsEarlyTest(const DepthSettings& settings, DepthComparison comparison, const DepthConvention& convention);

/// What is known of a range of keys that comes to a range that is there.
bool rejectsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest);
bool acceptsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest);

}  // namespace sightline
