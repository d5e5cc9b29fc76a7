// Opens a glTF: its container, what it requires, and its tables.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "sightline/tools/import/gltf/gltf_document.h"

namespace sightline::tools::gltf {

/// A document with its tables checked. A Fault if it is no glTF 2.0, or requires an extension that is not known.
/// @param directory  of the file, where its buffers are looked for; none: they are not opened
Document openDocument(ByteSource bytes, std::optional<std::string> directory, const Progress::Report& progress = {});

/// The same of a file, which may have 4 GiB.
Document openGltf(const std::string& path, const Progress::Report& progress = {});

}  // namespace sightline::tools::gltf
