// The report: one HTML page that needs no network and shows what was culled, by what, at which cost, and the proof.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "sightline/report/cull_run.h"
#include "sightline/scene/scene.h"

namespace sightline {

struct PageSettings {
    uint32_t most_pictures = 16;   ///< frames that are drawn; spread evenly, those with false culls first
    uint32_t picture_width = 640;  ///< [pixels]
    uint32_t picture_limit = 720;  ///< of the height [pixels]; a tall frame is drawn narrower
    /// Calls a function for each of so many numbers, perhaps on several threads; empty: one after the other.
    std::function<void(size_t count, const std::function<void(size_t)>& work)> for_each;
    std::function<void(size_t done, size_t total)> progress;  ///< from any of these threads; may be empty
};

/// The frames that are drawn, ascending.
std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most);

/// The whole page. Pictures, style and script lie in it.
std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings = {});

}  // namespace sightline
