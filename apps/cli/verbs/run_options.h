// What a user asks of every verb that moves a camera through a scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/verbs/scene_choice.h"
#include "sightline/geom/view.h"
#include "sightline/prepare/facing/merge_facing.h"
#include "sightline/tools/load/choose_path.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

struct OpenedVisibility;

/// Options of every verb that moves a camera through a scene.
struct RunOptions {
    SceneChoice scene;
    std::string path;       ///< a word for PathChoice::kind, or empty
    std::string eye, look;  ///< X,Y,Z of PathChoice's, or empty
    PathChoice choice;
    std::string size = "1280x720";
    uint32_t width = 1280, height = 720;  ///< from `size`
    uint32_t threads = 0;                 ///< 0: all cores
    int repeat = 3;
    std::vector<std::string> use, skip;
    QuerySettings settings = toolSettings();  ///< stages: from `use` and `skip`
    ViewPlanes sections;                      ///< View
    VisibilityAsked visibility;
    std::shared_ptr<const OpenedVisibility> opened;  ///< by openVisibility(): its file, or null
    double cluster_test = FacingCost().test;         ///< of a cluster  [triangles]
    std::string calibration;                         ///< file that says so; empty: none
    bool dear_shading = false;                       ///< which of its figures
    double jitter = 0.5;
    double stereo = 0;           ///< distance of the eyes  [world units]; 0: one eye
    uint32_t query_threads = 1;  ///< that share one query's bins
    uint64_t rays = 1000000;
    bool no_proofs = false;         ///< rays and samples alone judge
    bool lines_are_hidden = false;  ///< WitnessSettings
    std::string json;               ///< file, `-`, or empty
    std::string report;             ///< directory, or empty
    bool propose = false;           ///< tell the query what an image does not show: Proposer
    bool taught = false;            ///< another query draws each frame after this one, which learns from it
    bool certificates = false;      ///< fill FrameResult::certificates
    bool credits = false;           ///< fill FrameResult::credits: costs some tens of queries a frame
};

}  // namespace sightline::cli
