// A word as a shell takes it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::cli {

std::string quoted(const std::string& word);

}  // namespace sightline::cli
