// Where the parts of the panels are, by their words: for tests, which click there.
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

}  // namespace sightline::viewer
