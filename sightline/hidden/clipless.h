// A z-buffer that clips nothing: triangles are scanned by their edges in homogeneous space.
// SPDX-License-Identifier: MIT
//
// Marc Olano, Trey Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997.
#pragma once

#include "sightline/hidden/render.h"

namespace sightline {

/// Nearest surfaces by nearness in double, one thread. What the z-buffer draws under Clipping::kClipless; depth formats
/// do not apply.
void drawClipless(const HiddenInput& input, HiddenImage& image);

}  // namespace sightline
