// The windows of a frame, for pictures: the part of the image that each cell is seen through, as an outline.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/cells/portals.h"
#include "sightline/tools/report/pictures/window_picture.h"

namespace sightline::cli {
using namespace tools;

/// Finds windows as the stage of portals does, but for what rows leave out. Any number of threads may ask.
class WindowOverlay {
public:
    /// @pre RunOptions::opened
    explicit WindowOverlay(const RunOptions& options);

    /// Of no cell if the eye's cells are not known.
    std::vector<CellWindow> windows(const View& view, PortalWindows kind, uint32_t depth) const;

private:
    PortalGraph graph_;
    std::vector<DoorState> doors_;
};

}  // namespace sightline::cli
