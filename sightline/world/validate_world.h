// Whether a snapshot's tables, hierarchy and cells agree: in debug builds, after each commit.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/world/world_state.h"

namespace sightline::detail {

#ifdef SIGHTLINE_DEBUG_ASSERTS
/// Asserts what the comments of SnapshotState, PlacedBvh, PlacedLimits and CellState state. O(all that it holds); takes no
/// memory.
void validateWorld(const SnapshotState& state);
#else
inline void validateWorld(const SnapshotState&) {}
#endif

}  // namespace sightline::detail
