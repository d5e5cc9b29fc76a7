// Completions for bash, zsh and fish: each shell's script asks the tool what may stand at the cursor.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sightline::cli {

/// What may stand in the last word's place, one a line. Nothing: whatever it is, it is not known; a file, perhaps.
/// @param words  behind "sightline"; the last one is as far as it is typed  [size: >= 1]
/// @param cases  of the verb `bench`
std::string completionsOf(const CLI::App& tool, const std::vector<std::string>& words,
                          const std::vector<std::string>& cases);

/// The verb `completions SHELL`, which prints the script. The scripts run `sightline completions --words WORD...`, which
/// main() answers by completionsOf() before the words are parsed.
void addCompletions(CLI::App& tool, int& exit_code);

}  // namespace sightline::cli
