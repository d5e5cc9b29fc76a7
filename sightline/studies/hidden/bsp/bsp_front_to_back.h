// Hidden surfaces by a BSP tree, front to back: each sample is written once, and what is hidden need not be looked at.
// SPDX-License-Identifier: MIT
//
// Dan Gordon, Shuhong Chen. Front-to-Back Display of BSP Trees. 1991.
#pragma once

#include "sightline/studies/hidden/bsp/bsp_scene.h"
#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

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
