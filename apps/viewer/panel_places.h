// The parts of the panels: where each is, for tests, which click there; and what it means, where the mouse is.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace sightline::viewer {

struct PanelPlace {
    float left = 0, top = 0, right = 0, bottom = 0;
};
using PanelPlaces = std::map<std::string, PanelPlace>;

/// Notes where the part is that was drawn last.
void notePlace(PanelPlaces& places, const std::string& words);

/// Shows what the part that was drawn last means while the mouse is at it.
void showTip(const char* words);

}  // namespace sightline::viewer
