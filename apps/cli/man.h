// The manual page, from the options as they are.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace sightline::cli {

/// A page of section 1 in the macros of man(7).
/// @param version  "sightline 0.1.0"
std::string manualPage(const CLI::App& tool, const std::string& version);

/// The verb `man`, which prints it.
void addMan(CLI::App& tool, const std::string& version, int& exit_code);

}  // namespace sightline::cli
