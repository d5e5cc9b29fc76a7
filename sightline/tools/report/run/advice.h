// What would change a scene's frames, and by how much: as it was measured, in ten lines, and as JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/tools/report/run/profile_run.h"

namespace sightline::tools {

/// One change, tried on the scene's own frames.
struct Advice {
    enum class Kind : uint8_t {
        kStage,  ///< of the query: in use or not
        kBake,
        kSplit,
        kMerge,
    };

    Kind kind = Kind::kStage;
    std::string what;   ///< a stage's name; "23 objects with 1,234 triangles"
    std::string how;    ///< what to say to the tool; may be empty
    bool done = false;  ///< it is so already, and was undone to measure it
    double saves = 0;   ///< of a frame of the reference renderer: with it against without; below 0: it costs  [ms]
    double spread = 0;  ///< standard error  [ms]
    std::string helps;  ///< StageBenefit::words(), or empty
};

struct AdviceRun {
    std::string scene;    ///< as it was named by the user
    std::string command;  ///< words of the scene and the cameras, for commands in advice
    std::string machine;
    uint64_t objects = 0, triangles = 0;
    uint32_t width = 0, height = 0, frames = 0, threads = 1, rounds = 0;
    double frame_milliseconds = 0, query_microseconds = 0;
    Bottleneck bottleneck;
    std::vector<Advice> advice;
    std::vector<std::string> not_tried;  ///< "bake: more than 300,000 triangles"
};

/// Whether a change matters: by twice its spread, and by a hundredth of the frame.
bool matters(const Advice& advice, double frame_milliseconds);

/// At most ten lines: what was measured, what limits, the changes that matter by what they save, what makes no difference,
/// and what was not tried.
std::string adviceText(const AdviceRun& run);

/// The schema `sightline.advise/1`.
std::string adviceJson(const AdviceRun& run);

}  // namespace sightline::tools
