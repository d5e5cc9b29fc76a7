// What a case of the benchmark is asked.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

/// What `bench occlusion --verify` judges.
struct ProofOptions {
    bool wanted = false;             ///< judge instead of measuring
    uint32_t width = 0, height = 0;  ///< 0: 1280x720 and 1920x1080
    uint32_t jitters = 16;           ///< pictures of 4x4 samples a pixel, each shifted otherwise; 0: none
    uint32_t rays = 16;              ///< per hidden box; 0: none
    uint32_t cameras = 0;            ///< of a scene, the first; 0: all
};

struct Options {
    std::string name;              ///< one of names()
    std::string json;              ///< file for the rows as `sightline.bench/1`; `-`: standard output; empty: none
    const Scene* scene = nullptr;  ///< null: the case's own scenes
    int repeat = 0;                ///< measurements of each value, of which the median counts; 0: the case's own number
    std::vector<std::string> only;  ///< of sceneNames(), of the case "occlusion", and nothing else of it; empty: all
    uint32_t occlusion_size = 0;    ///< QuerySettings::occlusion_size where one is used; 0: the case's own
    ProofOptions proof;             ///< of the case "occlusion"
    std::function<void(size_t done, size_t total)> progress;  ///< called by cases that take minutes; may be empty
};

}  // namespace sightline::bench
