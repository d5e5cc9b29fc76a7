// Sorts polygons into runs that become clusters: compact pieces of what hangs together, gatherings of the rest.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Polygons in runs. Those of a joined run hang together: not always within the run.
struct Runs {
    struct Run {
        uint32_t first = 0, last = 0;  ///< of `order`
        bool joined = false;
    };
    std::vector<uint32_t> order;  ///< every polygon once
    std::vector<Run> runs;        ///< mesh by mesh if they are kept apart; the loose ones last
    std::vector<uint32_t> whole;  ///< per polygon: a number that those have in common that hang together, across meshes
};

struct RunLimits {
    bool by_mesh = true;         ///< keep meshes apart
    bool reach_across = false;   ///< what hangs together across meshes counts as one, though its runs are kept apart
    uint32_t most_joined = 0;    ///< polygons of a joined run
    uint32_t most_folded = 0;    ///< polygons of a joined run that do not face one way
    uint32_t most_loose = 0;     ///< polygons of a loose run
    uint32_t most_vertices = 0;  ///< of any run  [limit: >= 4]
};

/// What hangs together by shared sides and has three polygons or more is split where it is longest, until the pieces
/// fit; the rest is gathered. O(n log n), deterministic.
Runs sortIntoRuns(const Patchwork& patchwork, const RunLimits& limits);

}  // namespace sightline
