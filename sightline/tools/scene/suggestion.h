// A slip of the pen: which of some words was meant.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sightline::tools {

/// The nearest of some words as "; did you mean X?", or nothing if none is near enough to have been meant
/// and none, or more than one, begins with it.
std::string suggestion(const std::string& word, const std::vector<std::string>& words);

}  // namespace sightline::tools
