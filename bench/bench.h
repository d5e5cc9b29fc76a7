// The benchmark cases by name: the tool's verb `bench` and the benchmark binary call the same ones.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/scene/scene.h"

namespace sightline::bench {

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
    uint32_t occlusion_size = 0;    ///< View::occlusion_size where one is used; 0: the case's own
    ProofOptions proof;             ///< of the case "occlusion"
    std::function<void(size_t done, size_t total)> progress;  ///< called by cases that take minutes; may be empty
};

/// The cases that run() knows, in alphabetical order.
std::vector<std::string> names();

/// The scenes that the case "occlusion" has of its own.
std::vector<std::string> sceneNames();

/// Measures one case and prints its rows for a reader: on standard output, or on standard error if the JSON goes
/// to standard output.
/// @returns false if a proof that was asked for does not hold; its faults are then lines on standard error
/// Errors: a scene that cannot be read, a file that cannot be written, an unknown name.
Result<bool> run(const Options& options);

}  // namespace sightline::bench
