// What limits a scene's frames, what its parts cost, and what each stage of the query is worth there.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sightline/geom/stage.h"
#include "sightline/tools/profile/bottleneck.h"
#include "sightline/tools/profile/draw_costs.h"
#include "sightline/tools/profile/facing_costs.h"

namespace sightline::tools {

/// One set of stages on all frames of a run. Means over the frames; times are medians over the repeats before.
struct AblationRow {
    /// What differs from what was asked for.
    enum class Change : uint8_t {
        kNothing,
        kWithout,  ///< one stage is left out
        kWith,     ///< one stage more
        kNone,     ///< no stage at all: all objects are drawn
    };

    Change change = Change::kNothing;
    Stage stage = Stage::kFrustum;  ///< of kWithout and kWith
    double objects = 0;             ///< kept
    double triangles = 0;           ///< of them, or of what clusters leave: what is submitted
    double drawn = 0;               ///< polygons that the rasterizer gets: neither back faces nor outside
    double fragments = 0;           ///< that they have, hidden or not
    double shaded = 0;              ///< fragments, of the reference z-buffer
    double bytes = 0;               ///< carried
    double query_microseconds = 0;
    double frame_milliseconds = 0;  ///< query, submission and drawing by the reference renderer
    double frame_spread = 0;        ///< standard error of that  [ms]

    /// "as asked", "without occlusion", "with volumes", "no stage".
    std::string name() const;
};

/// What a stage is good for: how much more there is without it, as a share of what there is with it.
struct StageBenefit {
    Stage stage = Stage::kFrustum;
    bool in_use = true;             ///< as the run was asked
    double geometry = 0;            ///< triangles submitted
    double rasterizer = 0;          ///< fragments
    double bus = 0;                 ///< bytes
    double query_microseconds = 0;  ///< that it takes; below 0: it makes the query faster
    double milliseconds = 0;        ///< that it saves a frame of the reference renderer
    double spread = 0;              ///< standard error of that  [ms]

    /// "geometry, rasterizer", "nothing".
    std::string words() const;
};
/// One for each row that changes one stage.
std::vector<StageBenefit> benefitsOf(const std::vector<AblationRow>& rows);

/// What a driver counted of one frame, in the mean.
struct DriverCounts {
    double gpu_busy = 0;  ///< of a frame
    std::optional<double> vertices, triangles, fragments;
    double samples_passed = 0;
};

struct ProfileRun {
    std::string scene;     ///< as it was named by the user
    std::string renderer;  ///< "reference" or "gl"
    std::string driver;    ///< of the GL, as it says it
    std::string machine;
    uint64_t objects = 0, triangles = 0;  ///< of the scene
    uint32_t width = 0, height = 0, frames = 0, threads = 1;
    bool stream = false;  ///< meshes are carried each frame
    Bottleneck bottleneck;
    DrawCosts costs;
    FacingCosts facing;
    std::optional<DriverCounts> driver_counts;
    std::vector<AblationRow> ablation;  ///< the first is as asked
};

/// The verdict with the table that it comes from, the costs, and the table of stages.
std::string profileText(const ProfileRun& run);

/// The schema `sightline.profile/1`. Its "costs" have the fields of `sightline.calibration/1`, too: parseCalibration() reads
/// them.
std::string profileJson(const ProfileRun& run);

}  // namespace sightline::tools
