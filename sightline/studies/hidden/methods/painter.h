// The painter's algorithm: draw far to near, each polygon over what is there.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

/// Sorts by one depth a polygon, its centre's or its farthest point's (RenderSettings::painter_key). Neither is right in
/// general: a long polygon may have its centre behind a short one that it passes in front of. Of polygons at the same
/// depth the one of the lower number is drawn last, so that it stays, as in a z-buffer that keeps the first.
///
/// O(n log n) polygons; every fragment is shaded.
void drawPainter(const HiddenInput& input, HiddenImage& image);

}  // namespace sightline::studies
