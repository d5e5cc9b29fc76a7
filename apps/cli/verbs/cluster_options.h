// What clusters cost, on the command line: --cluster-test, --calibration, --dear-shading.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/verbs/run_options.h"

namespace sightline::cli {

void addClusterOptions(CLI::App& verb, RunOptions& options);

/// Reads the calibration, if one was given, into RunOptions::cluster_test.
Status finishClusterOptions(RunOptions& options);

/// With a blank before it; empty for the default.
std::string clusterOptionsOf(double cluster_test);

}  // namespace sightline::cli
