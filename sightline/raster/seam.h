// The polygons of drawn clusters that left seams, made when a seam is first asked for; and which of them share a side.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/raster/tiles.h"

namespace sightline {

/// The polygons that an entry names, in DepthTiles::polygons: of a drawn cluster its own, but for its ring; made at the
/// first call.
void seamPolygons(DepthTiles& tiles, const SeamEntry& entry, uint32_t& first, uint32_t& count);

/// Fills in the keys of a seam polygon's sides.
void setSideKeys(const DepthTiles& tiles, SeamPolygon& polygon);

/// Finds a side that two polygons share: the same edge of the world, exactly, run through in opposite directions.
bool findSharedSide(const DepthTiles& tiles, const SeamPolygon& a, const SeamPolygon& b, int& side_a, int& side_b);

}  // namespace sightline
