// Hidden-surface removal: every classical method, one signature, one image.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Robert Sproull, Robert Schumacker. A Characterization of Ten Hidden-Surface Algorithms. 1974.
#pragma once

#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

/// Draws one image, one sample a pixel, by the method chosen.
///
/// All methods show the same polygons: triangles that are not dropped as back faces, clipped and projected by one
/// Projector, a sample on a shared edge belonging to one of them. An exact method (all but the painter's) shows at each
/// sample the nearest; of surfaces at the same nearness (up to rounding) any of them. Surfaces that write no depth are
/// not drawn.
HiddenImage render(const DrawList& list, const View& view, const RenderSettings& settings);

}  // namespace sightline::studies
