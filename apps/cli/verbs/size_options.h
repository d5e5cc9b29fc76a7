// The options of distance and contribution culling, and what these cost in a run's pictures.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cli/verbs/run_options.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// --distance and --contribution.
void addSizeOptions(CLI::App& verb, RunOptions& options);

/// Checks them against --use, and takes the stages out of RunOptions::settings that have nothing to do. Errors are kUsage.
Status finishSizeOptions(RunOptions& options);

}  // namespace sightline::cli
