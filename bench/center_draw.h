// The rasterizer as it would be if a pixel's centre were enough: to measure what whole pixels cost. Not sound.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/raster/tiles.h"

namespace sightline {

/// drawCluster(), but a pixel is covered where its centre is, and no seams are left; see raster/centers.h.
void drawClusterByCenters(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips);

}  // namespace sightline
