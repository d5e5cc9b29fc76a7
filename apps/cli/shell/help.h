// How help looks and what it says beside the options, and what is known of an option beside its name.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sightline::cli {

bool isFlag(const CLI::Option& option);
/// What stands for the value in help: "N", "FILE.toml"; "TEXT" where the verb says nothing.
std::string valueName(const CLI::Option& option);
/// All values that the option takes, where they can be listed.
std::vector<std::string> choicesOf(const CLI::Option& option);
/// Its description, with the choices where neither that nor the value's name has them.
std::string helpOf(const CLI::Option& option);
/// True if the value is a list of stages, separated by commas.
bool isList(const CLI::Option& option);
/// True if the value names a file or a directory that may be written.
bool isWritten(const CLI::Option& option);

/// The names of all verbs.
std::vector<std::string> verbNames(const CLI::App& tool);

/// Puts the options of the tool and of its verbs under headings, and gives them the look of their help and its last
/// words. After all options were added.
void dressHelp(CLI::App& tool);

}  // namespace sightline::cli
