// Verbs that are built when they are asked for: what they are, which program has them, and what it says of itself.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/cli/shell/options.h"

namespace sightline::cli {

/// A verb that is not in the program `sightline`.
struct OtherVerb {
    std::string_view name;
    std::string_view about;    ///< for the list of verbs
    std::string_view program;  ///< beside this one, which the words are handed to
    /// Its options with spaces between: long names as files have them, an = behind those that name what is written, and
    /// short names with their dash. Empty: they are not known here.
    std::string_view options;
};

struct OtherOption {
    std::string_view name;  ///< as a configuration file has it
    bool written = false;
};

std::span<const OtherVerb> otherVerbs();
/// Null if there is none.
const OtherVerb* findOtherVerb(std::string_view name);
/// What a configuration file may set of a verb.
std::vector<OtherOption> optionsOf(const OtherVerb& verb);
/// Names of other verbs with an option, which has its dashes.
std::vector<std::string> otherOwners(std::string_view option);

/// What a program adds to the verbs of `sightline`.
struct HeldVerb {
    std::string_view name;
    void (*add)(Command& tool, int& exit_code) = nullptr;  ///< null: the shell has it
    std::vector<std::string> (*names)() = nullptr;         ///< what its NAME may be, where that is known
};

/// Adds one of otherVerbs() to the tool, without options.
Command addOtherVerb(Command& tool, std::string_view name);

}  // namespace sightline::cli
