// The windows of a frame, for pictures: the part of the image that each cell is seen through, as an outline.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "apps/cli/visibility_choice.h"
#include "sightline/cull/portals.h"
#include "sightline/report/window_picture.h"

namespace sightline::cli {

/// Finds windows as the stage of portals does, but for what rows leave out. Any number of threads may ask.
class WindowOverlay {
public:
    /// @pre RunOptions::opened
    explicit WindowOverlay(const RunOptions& options);

    /// Of no cell if the eye's cells are not known.
    std::vector<CellWindow> windows(const View& view, PortalWindows kind) const;

private:
    PortalGraph graph_;
    std::vector<DoorState> doors_;
};

}  // namespace sightline::cli
