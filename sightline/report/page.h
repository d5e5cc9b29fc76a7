// The report: one HTML page that needs no network and shows what was culled, by what, at which cost, and the proof.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "sightline/report/cull_run.h"
#include "sightline/report/png.h"
#include "sightline/report/window_picture.h"
#include "sightline/scene/scene.h"

namespace sightline {

struct PageSettings {
    uint32_t most_pictures = 64;   ///< frames that are drawn; spread evenly, those with false culls first
    uint32_t picture_width = 960;  ///< [pixels]; of more than 32 pictures, 720 at most
    uint32_t picture_limit = 720;  ///< of the height [pixels]; a tall frame is drawn narrower
    /// Calls a function for each of so many numbers, perhaps on several threads; empty: one after the other.
    std::function<void(size_t count, const std::function<void(size_t)>& work)> for_each;
    std::function<void(size_t done, size_t total)> progress;  ///< from any of these threads; may be empty
    /// Takes a PNG that is to lie beside the page, "frames/plan-0007.png", from any of these threads; may be empty.
    std::function<void(const std::string& name, const std::string& bytes)> save;
    /// Draws the occlusion buffer of a frame (depthPicture()), on any of these threads; empty: the page has none.
    std::function<Image<Rgb>(size_t frame)> buffer;
    /// Finds the windows through which a frame's cells are seen, on any of these threads; empty: the page has none.
    std::function<std::vector<CellWindow>(size_t frame, PortalWindows kind)> windows;
};

/// The frames that are drawn, ascending.
std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most);

/// The whole page. Pictures, style and script lie in it.
std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings = {});

struct Film;

/// The page of a run that was read from its file: without its scene, and with the pictures that lie beside the file.
/// @param names  of all keys that VerificationRow::kept_unseen of the run's frames stands for by their places here
std::string runPage(const CullRun& run, const std::vector<KeyName>& names, const Film& film);

}  // namespace sightline
