// What several verbs share: the common options, scenes by name, camera paths, errors.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/scene_choice.h"
#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/prepare/merge_facing.h"
#include "sightline/report/cull_run.h"
#include "sightline/scene/camera_path.h"
#include "sightline/scene/scene.h"

namespace CLI {
class App;
}

namespace sightline::cli {

struct OpenedVisibility;

/// Options of every verb that moves a camera through a scene.
struct RunOptions {
    SceneChoice scene;
    std::string cameras;  ///< file; empty: none
    uint32_t frames = 0;  ///< 0: not given
    uint64_t seed = 1;
    bool seed_given = false;
    std::string size = "1280x720";
    uint32_t width = 1280, height = 720;  ///< from `size`
    uint32_t threads = 0;                 ///< 0: all cores
    int repeat = 3;
    std::vector<std::string> use, skip;
    uint32_t stages = 0;      ///< from `use` and `skip`
    double max_distance = 0;  ///< View; 0: not given
    double contribution = 0;  ///< the same
    ViewPlanes sections;      ///< View
    VisibilityAsked visibility;
    std::shared_ptr<const OpenedVisibility> opened;  ///< by openVisibility(): its file, or null
    double cluster_test = FacingCost().test;         ///< of a cluster  [triangles]
    std::string calibration;                         ///< file that says so; empty: none
    bool dear_shading = false;                       ///< which of its figures
    double jitter = 0.5;
    uint32_t occluder_triangles = View().occluder_triangles;
    double occluder_error = 0;  ///< View::occluder_error; 0: no simpler occluders are prepared
    double stereo = 0;          ///< distance of the eyes  [world units]; 0: one eye
    bool last_visible_first = false;
    double hysteresis = 0;
    bool no_faces = false, no_second_look = false;
    uint32_t second_look_polygons = View().second_look_polygons;
    bool masked = false;
    double close_gaps = 0;
    uint32_t occlusion_size = View().occlusion_size;
    uint32_t bins = 1;           ///< View::bins
    uint32_t query_threads = 1;  ///< that share one query's bins
    uint64_t rays = 1000000;
    std::string json;      ///< file, `-`, or empty
    std::string report;    ///< directory, or empty
    bool credits = false;  ///< fill FrameResult::credits: costs some tens of queries a frame
};

/// The scene, its cameras, the size, threads and JSON: what every verb has that looks at a scene.
/// @param shared  what the threads share: "the frames"
void addCameraOptions(CLI::App& verb, RunOptions& options, const std::string& shared);
/// --occlusion-size, as cull and others have it.
void addOcclusionSize(CLI::App& verb, uint32_t& size);
/// These, and what culling needs.
void addSceneOptions(CLI::App& verb, RunOptions& options);
/// --stereo.
void addStereoOption(CLI::App& verb, RunOptions& options);
/// And what cull and verify may ask a query for besides: two eyes, what was visible last first.
void addQueryOptions(CLI::App& verb, RunOptions& options);
/// Checks what single options cannot: sizes, stage names. Errors are kUsage.
Status finish(const CLI::App& verb, RunOptions& options);

/// Reads "1920x1080".  [1 to 16384]
/// @param option  what an error, kUsage, calls it
Status readSize(const std::string& option, const std::string& text, uint32_t& width, uint32_t& height);

/// Which path: --cameras; --frames and --seed; a city's streets for --frames alone; the scene's own; 16 seeded.
Result<CameraPath> loadPath(const Scene& scene, const RunOptions& options);

/// Prints one line on standard error.
/// @return the exit code of the error's kind
int report(const Error& error);

/// Writes text to a file aside and renames it, or to standard output for `-`.
Status writeText(const std::string& file, const std::string& text);

/// 1234567 as "1,234,567".
std::string grouped(uint64_t number);
/// A word as a shell takes it.
std::string quoted(const std::string& word);

}  // namespace sightline::cli
