// A bake as the tool runs it: with progress, a limit of time, and a state on disk that it goes on from.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "sightline/bake/cell_visibility.h"
#include "sightline/base/result.h"

namespace sightline::cli {

struct VisBakeOptions {
    uint64_t budget = 0;        ///< CellVisibilitySettings
    double time_limit = 0;      ///< [s]; 0: none
    std::string state;          ///< file; empty: none
    bool keep_follows = false;  ///< CellVisibilitySettings
};

/// Bakes; goes on from the state's file if there is one of this graph and budget, and writes it now and then. Ctrl-C
/// stops it gently, and the state is there for the next time. Errors: a state that cannot be written.
Result<CellVisibility> bakeVis(const CellGraph& graph, const VisBakeOptions& options, Jobs& jobs);

/// Once the result is written.
void removeBakeState(const VisBakeOptions& options);

}  // namespace sightline::cli
