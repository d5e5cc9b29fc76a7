// Reads the formats that Assimp knows, in a process of their own.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/tools/import/import_settings.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// The program sightline-import: as the settings say; as SIGHTLINE_IMPORT says; beside the running program; in
/// libexec/sightline of where that or the library was installed. Empty: there is none.
std::string findImportWorker(const ImportSettings& settings);

/// Lets sightline-import read a file, under the settings' limits. Whatever becomes of that process, this one goes on.
///
/// Errors are one line with the file's name: the program is missing or cannot be started; it needs more memory or time
/// than allowed; it crashed; what it says of the file; what it sent cannot be believed.
/// @param suffix  of the format, without a dot: "obj"
Result<Scene> loadForeign(const std::string& file, std::string_view suffix, const ImportSettings& settings);

}  // namespace sightline::tools
