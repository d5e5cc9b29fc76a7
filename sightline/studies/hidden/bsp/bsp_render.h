// Hidden surfaces by a BSP tree: back to front as a painter, or front to back, where each sample is written once.
// SPDX-License-Identifier: MIT
//
// Dan Gordon, Shuhong Chen. Front-to-Back Display of BSP Trees. 1991.
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#pragma once

#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

/// Builds the tree (HiddenCounters::prepare_nanoseconds) and draws. Exact: of polygons in one plane the one of the lower
/// number is drawn last. Surfaces that lie in each other by less than the planes' thickness count as one plane.
///
/// Building takes O(n log n) for scenes, drawing O(pieces); every fragment is shaded.
void drawBspBackToFront(const HiddenInput& input, HiddenImage& image);

/// Draws with a tree that is kept, and with what moves in it.
/// @param scene  of the same list
void drawBspBackToFront(const BspScene& scene, const HiddenInput& input, HiddenImage& image);

/// Builds the tree (HiddenCounters::prepare_nanoseconds) and draws; the same image as drawBspBackToFront(), sample for
/// sample. RenderSettings::free_samples says how it knows what is free. With kSegments and kBits it ends when the screen
/// is full, and leaves out subtrees and pieces whose part of the screen is full: their fragments are not generated.
///
/// Of the counters, passed and shaded are the samples covered; generated and tested are the samples of all spans that
/// were scanned, however many of them were looked up at once.
void drawBspFrontToBack(const HiddenInput& input, HiddenImage& image);

/// Draws with a tree that is kept, and with what moves in it.
/// @param scene  of the same list
void drawBspFrontToBack(const BspScene& scene, const HiddenInput& input, HiddenImage& image);

}  // namespace sightline::studies
