// What the verb `info` tells of a visibility file.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"

namespace sightline::cli {

/// By its first bytes; false if it cannot be read.
bool isVisibilityFile(const std::string& file);

/// Prints what it holds, and writes the schema `sightline.visibility/1`.
/// @param json  file, `-` (then nothing is printed), or empty
/// Errors: what VisibilityFile::open() says (kInput), a file that cannot be written (kOutput).
Status infoOfVisibility(const std::string& file, const std::string& json);

}  // namespace sightline::cli
