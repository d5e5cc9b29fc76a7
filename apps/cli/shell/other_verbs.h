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
    /// The long names of its options that no verb of `sightline` has, with spaces between: configuration files may set
    /// them, and messages say whose they are.
    std::string_view options;
};

std::span<const OtherVerb> otherVerbs();
/// Null if there is none.
const OtherVerb* findOtherVerb(std::string_view name);
/// Names of other verbs with an option.
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
