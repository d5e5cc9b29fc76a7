// Sorts polygons into runs that become clusters: compact pieces of what hangs together, and gatherings of what does not.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/prepare/patchwork.h"

namespace sightline {

/// Polygons in runs. Those of a joined run hang together in their mesh: not always within the run.
struct Runs {
    struct Run {
        uint32_t first = 0, last = 0;  ///< of `order`
        bool joined = false;
    };
    std::vector<uint32_t> order;  ///< every polygon once
    std::vector<Run> runs;        ///< mesh by mesh; of each mesh, the loose ones last
    std::vector<uint32_t> whole;  ///< per polygon: a number that those have in common that hang together, across meshes
};

/// What hangs together by shared sides and has three polygons or more is split where it is longest, until the pieces
/// fit; the rest is gathered. O(n log n), deterministic.
///
/// @param by_mesh      keep meshes apart
/// @param most_joined  polygons of a joined run; of a loose one there are at most OccluderCluster::kMaxLoose.
///                     Any run has at most OccluderCluster::kMaxVertices vertices
Runs sortIntoRuns(const Patchwork& patchwork, bool by_mesh, uint32_t most_joined);

}  // namespace sightline
