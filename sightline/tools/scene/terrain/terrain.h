// A procedural terrain: a height field in chunks, lakes, woods, rocks and farms.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Builds size x size samples, 2 m apart, deterministic in (seed, size). Metres, y up, the origin in the middle. The
/// height at a place depends on the seed alone: a larger terrain surrounds the smaller one of the same seed.
///
/// The ground is cut into chunks of 64 x 64 squares (the last ones smaller), each an object in the world's own
/// coordinates; chunks share the positions along their borders bit for bit. Lakes are sheets of opaque water over the
/// chunks that reach below their level. Trees, rocks, houses and fences are instances that stand on the
/// ground: about 3 for each 1000 square metres, and at most 200,000 of them. Crowns of spruces are closed and
/// opaque; those of leafy trees are masked.
///
/// Memory grows with the samples: 36 bytes each.
/// @param size  [limit: 16 to 8192]
Scene makeTerrain(uint64_t seed, uint32_t size);

}  // namespace sightline::tools
