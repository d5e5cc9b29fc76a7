// The options of what was baked: the visibility file, how windows are known, and how far doors are open.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/verbs/run_options.h"

namespace sightline::cli {
using namespace tools;

/// --visibility, --windows, --portal-depth and --door.
void addVisibilityOptions(CLI::App& verb, RunOptions& options);
/// Checks them, after the stages are known: without a file the stages of cells are out of use. Errors are kUsage.
Status finishVisibilityOptions(RunOptions& options);

/// The options again, as a shell takes them, each with a space before it; what is default is left out.
std::string visibilityOptionsOf(const VisibilityAsked& asked);

}  // namespace sightline::cli
