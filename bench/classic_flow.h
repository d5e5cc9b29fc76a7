// Portal flow as the map tools of the Quake family do it, plainly: what cell visibility is measured beside.
// SPDX-License-Identifier: MIT
//
// Michael Abrash. Inside Quake: Visible-Surface Determination. 1996.
#pragma once

#include <cstdint>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cells.h"

namespace sightline::bench {

struct ClassicFlow {
    BitMatrix visible;        ///< [cells x cells]; not made symmetric; each cell sees itself
    uint64_t steps = 0;       ///< portals that were clipped
    uint32_t flowed = 0;      ///< directed portals that are done; of the rest, what half-spaces leave is visible
    double milliseconds = 0;  ///< of this thread
    bool finished = false;
};

/// Depth first from each directed portal: half-spaces first; then each portal of a chain clipped by planes that separate
/// the first from the one before, the first by those of the other two, and what may still be seen narrowed by what each portal
/// of the chain may see. No rays, no targets, one thread, no vectors.
/// @param limit  it gives up after this much computing  [milliseconds]
ClassicFlow classicFlow(const CellGraph& graph, double limit);

}  // namespace sightline::bench
