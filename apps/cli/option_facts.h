// What the options of a verb are, for all that lists them: help, the man page, completions, the configuration.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sightline::cli {

struct OptionFacts {
    const CLI::Option* option = nullptr;
    std::vector<std::string> names;    ///< "-o" and "--output", or "SCENE" of what has no dashes
    std::string value;                 ///< what stands for the value: "N", "FILE"; empty for flags
    std::vector<std::string> choices;  ///< all values that it takes, if they can be listed
    std::string help, standard;        ///< what it does; its default, or empty
    std::string group;                 ///< the heading that it stands under
    bool positional = false;
    bool required = false;
    bool several = false;  ///< takes several words
    bool list = false;     ///< its value is `choices`, separated by commas

    /// The longest name without dashes: the key of a configuration file.
    std::string key() const;
    /// True if the value names a file or a directory that is written.
    bool writes() const;
};

/// In the order of their headings: input, cameras, culling, what verbs have of their own, output, general.
std::vector<OptionFacts> optionsOf(const CLI::App& app);

/// Those that are shown, in order.
std::vector<const CLI::App*> verbsOf(const CLI::App& tool);

/// Puts options that no heading was given to under one: what names a file to write under Output.
void groupOptions(CLI::App& app);

}  // namespace sightline::cli
