// Draws loose clusters: small polygons by the batch, the others one by one.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/tiles.h"

namespace sightline {

/// Draws a cluster whose polygons share no sides, or more than can be drawn together; see drawCluster().
void drawLooseCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, bool flips);

}  // namespace sightline
