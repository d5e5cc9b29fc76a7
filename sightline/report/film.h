// The film of a run: for each frame that is drawn, what the camera sees, what was culled, and where that lies.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/report/cull_run.h"
#include "sightline/report/page.h"
#include "sightline/scene/scene.h"

namespace sightline {

/// A picture as the page holds it.
struct FilmImage {
    std::string id;     ///< of its element in the page
    std::string bytes;  ///< of a PNG or a JPEG
};

/// One frame as it is shown in the player.
struct Shot {
    size_t frame = 0;
    std::vector<FilmImage> images;
    std::string plan_text, section_text;   ///< what the drawings show
    std::string windows_text;              ///< what the windows show; empty: there are none
    double depth_all = 0, depth_kept = 0;  ///< surfaces drawn for a pixel, mean
    bool same = true;                      ///< the picture with culling is the same, sample by sample
};

struct Film {
    std::vector<Shot> shots;
    uint32_t width = 0, height = 0;  ///< of the pictures
    double heat_scale = 8;           ///< what both heat maps of all shots show brightest; 0: not known, nor means
};

/// Draws the frames that pictureFrames() chooses; hands full pictures to settings.save.
Film drawFilm(const Scene& scene, const CullRun& run, const PageSettings& settings);

}  // namespace sightline
