// Whether a pixel counts as covered where its centre is. It never does: but for a benchmark of what soundness costs.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

#ifdef SIGHTLINE_RASTER_CENTERS
/// bench/center_draw.cpp builds the drawing once more like this, under other names: no pixel is left aside for its edges,
/// and all else is as it is. It hides what can be seen.
constexpr bool kCentersOnly = true;
#else
constexpr bool kCentersOnly = false;
#endif

}  // namespace sightline
