// Warnock's algorithm: divide the screen until each window is simple.
// SPDX-License-Identifier: MIT
//
// John Warnock. A Hidden Surface Algorithm for Computer Generated Halftone Pictures. 1969.
#pragma once

#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

/// Polygons are disjoint from a window, contained in it, intersect it or surround it. A window is drawn if there is
/// none but disjoint ones (background), one alone (its samples there), or a surrounding one in front of all others at
/// the window's four corner samples; else it is quartered. At one sample the nearest polygon is drawn, the first of
/// equals. What lies behind a surrounding polygon at all four corners is dropped there and then; children inherit what
/// is left, and what surrounds the parent is not classified again.
///
/// A polygon surrounds a window only if it does so by more than rounding; which samples a window's polygon has is asked
/// of scanPolygon(), so that coverage is that of every other method. Practical up to some hundred thousand polygons of
/// some samples each: a polygon is looked at in each window of O(log size) levels that its outline passes, and time is
/// in proportion to the length of visible outlines.
void drawWarnock(const HiddenInput& input, HiddenImage& image);

}  // namespace sightline::studies
