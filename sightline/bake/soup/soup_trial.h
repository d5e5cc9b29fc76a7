// How much is seen from some places of a division into cells.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/bake/soup/soup_report.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// Looks round from each of SoupCellSettings::eyes, by walks through the portals alone: objects count that lie in cells
/// which are seen, whether or not they lie in their windows. O(objects + eyes * walk).
SoupTrial trialOf(const Scene& scene, const SoupCells& cells, const SoupCellSettings& settings, double diagonal);

}  // namespace sightline::bake
