// Writes files aside and renames them: a crash leaves the old file.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "sightline/base/result.h"

namespace sightline::tools {

/// Writes the whole file or leaves what was there: into a new file of the same directory, to the disk, then renamed.
/// Errors (kOutput) name the file: no such directory, a directory of that name, not permitted, disk full.
Status writeFileAside(const std::string& file, std::string_view bytes);

/// Whether writeFileAside is likely to succeed, for a check before long work; the same errors.
Status canWriteFile(const std::string& file);

/// A name that no file has: the stem, the extension with its dot, and between them "-2", "-3" and so on where that is needed.
std::string freeFileName(const std::string& stem, const std::string& extension);

/// Makes a directory and its parents, or finds them there. Errors (kOutput) name it.
Status makeDirectory(const std::string& directory);

}  // namespace sightline::tools
