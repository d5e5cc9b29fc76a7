// The film of a run: for each frame that is drawn, what the camera sees, what was culled, and where that lies.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sightline/cells/cell_space.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/pictures/window_picture.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// What is drawn of a run.
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
    const CellSpace* cells = nullptr;  ///< of a visibility file, for the plans; null: those of the scene
};

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
    double variety = 0;                    ///< how many objects share the picture: varietyOf(); 0: not known
};

struct Film {
    std::vector<Shot> shots;
    uint32_t width = 0, height = 0;  ///< of the pictures
    double heat_scale = 8;           ///< what both heat maps of all shots show brightest; 0: not known, nor means
    std::string overview;            ///< overviewPicture(), of a PNG or a JPEG; empty: there is none
    std::vector<std::optional<glm::dvec2>> eyes;  ///< Overview::eyes, of all frames of the run; empty: not known
};

/// As many objects as would share a picture evenly for it to be as various as this one: 1 of a blank wall.
/// Claude E. Shannon. A Mathematical Theory of Communication. 1948: two to the power of its entropy.
/// @param objects  one colour an object
double varietyOf(const Image<Rgb>& objects);

/// The frames that are drawn, ascending.
std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most);

/// Draws the frames that pictureFrames() chooses; hands full pictures to settings.save.
Film drawFilm(const Scene& scene, const CullRun& run, const PageSettings& settings);

}  // namespace sightline::tools
