// Hidden surfaces by a BSP tree, back to front: a painter whose order is right for every scene and every eye.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#pragma once

#include "sightline/studies/hidden/bsp/bsp_scene.h"
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

}  // namespace sightline::studies
