// Completions for shells, from the options as they are.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace sightline::cli {

/// A script that a shell reads once.
/// @param shell  "bash", "zsh" or "fish"
std::string completionScript(const CLI::App& tool, const std::string& shell);

/// The verb `completions SHELL`, which prints it.
void addCompletions(CLI::App& tool, int& exit_code);

}  // namespace sightline::cli
