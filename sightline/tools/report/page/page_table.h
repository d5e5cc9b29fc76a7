// The table of objects in a report: what each is called, how often it was kept, and what culled it in each frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

struct NamedObjects {
    struct Row {
        uint64_t key = 0;
        std::string name, path;
        uint64_t triangles = 0;
        uint64_t kept = 0;  ///< frames
    };
    std::vector<Row> rows;            ///< those kept in most frames first
    std::vector<std::string> stages;  ///< per frame, a digit a row: 0 visible, else 1 + Stage  [size of each: rows]
    uint64_t left_out = 0;            ///< keys that did not find room
};

/// Of more keys than there is room for, those kept in most frames, and of the others those with most triangles.
/// @param most        rows
/// @param most_cells  rows times frames: a long path has fewer rows
NamedObjects objectTable(const Scene& scene, const CullRun& run, size_t most = 5000, size_t most_cells = 2000000);

/// The same of what a run's file holds: keys that were kept at all; `1` stands for culled by any stage.
NamedObjects objectTable(const std::vector<KeyName>& names, const CullRun& run, size_t most = 5000,
                         size_t most_cells = 2000000);

}  // namespace sightline::tools
