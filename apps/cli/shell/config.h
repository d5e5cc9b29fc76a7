// Defaults of options from a configuration file in TOML: which file, what it may say, and what is in effect.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"

namespace CLI {
class App;
}

namespace sightline::cli {

struct SessionOptions;

/// A configuration file as it was found.
struct ConfigChoice {
    std::string file;   ///< empty: none
    bool here = false;  ///< in the current directory, where it may come from somebody else
};

/// --config; else ./sightline.toml; else $XDG_CONFIG_HOME/sightline/config.toml, where ~/.config stands for a variable
/// that is not set or not absolute. Nothing with --no-config.
ConfigChoice findConfig(const SessionOptions& options);

/// Gives options that the command line does not have their values from the file. What the section of the verb says
/// comes before what stands above all sections, and that only holds for verbs with such an option. The whole file is
/// checked for keys and sections that no verb has, values for those of the verb.
/// Errors (kInput) name the file and the line.
Status applyConfig(const CLI::App& tool, CLI::App& verb, const ConfigChoice& choice);

/// The verb `config`: every option with what the file says of it, as a file.
void addConfig(CLI::App& tool, const SessionOptions& session, int& exit_code);

}  // namespace sightline::cli
