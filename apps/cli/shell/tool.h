// What the tool does with its words: the verbs, what comes before them, and the exit code.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

#include "apps/cli/shell/other_verbs.h"

namespace sightline::cli {

/// All of main().
/// @param held  verbs that this program has beside those of `sightline`
int toolMain(int count, char** words, std::initializer_list<HeldVerb> held);

}  // namespace sightline::cli
