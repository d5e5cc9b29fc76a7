// The options of what was baked: the visibility file, how windows are known, and how far doors are open.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/common.h"

namespace sightline::cli {

/// --visibility, --windows, --portal-depth and --door.
void addVisibilityOptions(CLI::App& verb, RunOptions& options);
/// Checks them, after RunOptions::stages is known: without a file the stages of cells are out of use. Errors are kUsage.
Status finishVisibilityOptions(RunOptions& options);

/// The options again, as a shell takes them, each with a space before it; what is default is left out.
std::string visibilityOptionsOf(const VisibilityAsked& asked);

/// What of them a view takes.
void applyVisibility(const VisibilityAsked& asked, View& view);

}  // namespace sightline::cli
