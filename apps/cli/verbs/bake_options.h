// The options that `bake` and `vis` share: what a bake may cost, and what is written.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "apps/cli/shell/apart.h"
#include "apps/cli/verbs/vis_map.h"
#include "sightline/base/result.h"

namespace CLI {
class App;
}

namespace sightline::cli {

struct BakeOptions {
    std::string output, json, report;  ///< empty: not written
    std::string cells;                 ///< empty: not given
    std::string state;                 ///< file; empty: finish() names it after the output, if there is one
    uint32_t threads = 0;              ///< 0: all cores
    uint64_t budget = 0;               ///< BakeSettings
    double time_limit = 0;             ///< BakeSettings  [s]
    bool in_place = false, objects = false;

    VisCells visCells() const;
};

/// @param output  what `-o` writes
void addBakeOptions(CLI::App& verb, BakeOptions& options, const std::string& output);

/// Names the state, and checks that what is written is apart from what is read and can be written.
/// @param files  what is read, and what else the verb writes. Errors: kUsage, kOutput.
Status finishBakeOptions(BakeOptions& options, ApartFiles& files);

}  // namespace sightline::cli
