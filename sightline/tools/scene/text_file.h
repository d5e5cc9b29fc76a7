// A whole file as text, or the one line that says why not.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"

namespace sightline::tools {

/// Reads a file to its end. Errors (kInput) name the file: it is missing, a directory, not permitted,
/// fails while it is read, or is larger than the limit.
/// @param limit  [bytes]
Result<std::string> readTextFile(const std::string& file, size_t limit = size_t(1) << 30);

}  // namespace sightline::tools
