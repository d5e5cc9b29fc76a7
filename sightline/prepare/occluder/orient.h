// Turns double-sided triangles so that neighbours wind the same way.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Which way a double-sided triangle winds does not change what it hides, but only neighbours that wind the same way
/// run along their side in opposite directions, and so hang together. Turns them where two and no more share a side; on
/// a surface of one side (a Moebius strip) some sides stay as they are. O(n log n), deterministic.
///
/// @param patchwork  its polygons are triangles
void orientDoubleSided(Patchwork& patchwork);

}  // namespace sightline
