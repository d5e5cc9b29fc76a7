// The option of section planes.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/verbs/run_options.h"

namespace sightline::cli {

/// --section, as often as there are planes.
void addSectionOptions(CLI::App& verb, RunOptions& options);

/// " --section=A,B,C,D" of each.
std::string sectionOptionsOf(const ViewPlanes& sections);

}  // namespace sightline::cli
