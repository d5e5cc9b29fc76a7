// What compilers' tools of the Quake family are told with one dash, as the verb `vis` takes it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"

namespace sightline::cli {

/// The words of a command line that begins with `vis`, with the options of ericw-tools' `vis`, `q3map2 -vis` and VHLT's
/// `hlvis` in the form of its own. What only says how these work is left out, with a note; what would give other rows is
/// an error (kUsage) that names it. Words of other verbs, and words that are unknown here, stay.
Result<std::vector<std::string>> visWords(const std::vector<std::string>& words);

}  // namespace sightline::cli
