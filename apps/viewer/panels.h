// The viewer's panels: what they show, what they change, and what they ask for.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "apps/viewer/bsp_painter.h"
#include "apps/viewer/culler.h"
#include "apps/viewer/object_clusters.h"
#include "apps/viewer/panel_places.h"
#include "apps/viewer/side_by_side.h"
#include "apps/viewer/viewer_state.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::viewer {

/// What panels show beside the user's choices and the answer.
struct PanelFacts {
    const tools::Scene& scene;
    const tools::CameraPath& path;
    size_t path_frame = 0;
    uint32_t width = 0, height = 0;  ///< of the image  [pixels]
    uint64_t triangles = 0;          ///< drawn
    size_t left_out = 0;             ///< boxes or ghosts
    double size = 1;                 ///< of the scene  [world units]
    glm::dvec3 eye{0.0}, ahead{0, 0, -1};
    bool knows_cells = false;  ///< where they are
    const QuerySettings& begun;
    bool times = true;  ///< are shown
    std::span<const float> frame_milliseconds, query_microseconds;
    const SideBySide* ways = nullptr;
    const std::string& ways_problem;
    const BspPainter* painter = nullptr;
    const std::string& bsp_problem;
    const ObjectClusters* clusters = nullptr;
    size_t clusters_back = 0;  ///< of these, seen from their backs
};

/// What the user asked of them that is more than a choice.
struct PanelWishes {
    std::optional<size_t> go_to;     ///< a frame of the path
    std::optional<uint32_t> choose;  ///< an object
    bool explain = false, look_at_chosen = false, let_go = false, save_path = false, save_frame = false;
};

/// Between Gui::begin() and Gui::draw().
PanelWishes drawPanels(const PanelFacts& facts, ViewerState& state, Culler& culler, PanelPlaces& places);

}  // namespace sightline::viewer
