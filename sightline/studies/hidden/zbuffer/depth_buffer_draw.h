// Draws polygons into one row of a depth buffer's tiles: coverage, hierarchical rejection, depth test.
// SPDX-License-Identifier: MIT
//
// Juan Pineda. A Parallel Algorithm for Polygon Rasterization. 1988. (Samples by tiles.)
#pragma once

#include <cstdint>
#include <span>

#include "sightline/studies/hidden/zbuffer/depth_buffer_fragments.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer_polygon.h"

namespace sightline::studies {

/// Draws those polygons of the batches that meet a row of tiles, in order. Covers exactly the samples of
/// scanPolygon() (or scanHomogeneous()); a fragment that the test lets pass writes its depth and its surface. The same
/// bits on every instruction set.
void drawTileRow(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
                 DepthDrawScratch& scratch);

}  // namespace sightline::studies
