// What a file is, by its first bytes and its suffix, and who reads it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sightline/base/result.h"

namespace sightline::tools {

/// What a format says of the sides of its surfaces.
enum class SidesRule : uint8_t {
    kNothing,   ///< nothing: both sides are drawn
    kMaterial,  ///< each material does: one that does not say that it has two sides has one
};

struct SceneFormat {
    std::string_view suffixes;  ///< "obj"; several are separated by blanks, the first is the usual one
    std::string_view name;
    std::string_view reader;  ///< "sightline"; others read in sightline-import
    bool tested;              ///< by the project's own tests
    SidesRule sides;

    bool ours() const { return reader == "sightline"; }
};

/// All formats that can be read.
std::span<const SceneFormat> sceneFormats();
/// The one with this suffix, which has no dot and is in lower case; null: none.
const SceneFormat* sceneFormat(std::string_view suffix);

struct SceneKind {
    const SceneFormat* format = nullptr;  ///< null: it is not read
    std::string suffix;                   ///< by which its reader knows it: one of the format's
    std::string refusal;                  ///< then: what it is and what to do, to be put behind "FILE: "
};

/// How many of a file's bytes are looked at.
constexpr size_t kSceneHead = size_t(1) << 16;

/// What a file is. Where its first bytes are sure, they decide; else its suffix does.
/// @param head  the first kSceneHead bytes of the file, or all of it
/// @param size  of the whole file [bytes]
SceneKind sceneKind(const std::string& file, std::string_view head, uint64_t size);

/// The same of a file on disk. Errors (kInput): it is missing, a directory, or cannot be read.
Result<SceneKind> fileKind(const std::string& file);

}  // namespace sightline::tools
