// One view by several ways of culling, as a table.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "apps/viewer/side_by_side.h"

namespace sightline::viewer {

/// A window of its own, between Gui::begin() and Gui::draw().
/// @param ways        null: nobody has asked yet, or they cannot
/// @param problem     why not
/// @param times       are shown
/// @param doors_shut  some are not open, and the card draws no door
/// @param height      of the image  [pixels]
/// @param open        becomes false where the user shuts it
void drawWays(const SideBySide* ways, const std::string& problem, bool times, bool doors_shut, uint32_t height,
              bool& open);

}  // namespace sightline::viewer
