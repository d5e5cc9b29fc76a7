// Which scene a verb is to look at: files, procedural ones or several of both, and how files are read.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/cli/shell/options.h"
#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/scene/split.h"

namespace sightline::cli {
using namespace tools;

struct SceneChoice {
    std::vector<std::string> names;  ///< files and procedural scenes; several are joined in this order
    // How files are read, as the options say it; empty: not given.
    std::string up, unit, sides, memory, time;
    std::string split;  ///< for readSplit(); empty: meshes stay whole

    /// For a reader: "a.glb + b.glb".
    std::string title() const;
    /// As a shell takes it, with the options that differ from their defaults.
    std::string words() const;
    /// The one procedural scene's specification, or empty.
    std::string procedural() const;
    /// The one file that is read as it is, without a word of how; or empty.
    std::string plainFile() const;
};

/// SCENE and the options of importing.
void addSceneChoice(Command& verb, SceneChoice& choice);
/// The options of importing alone.
void addImportOptions(Command& verb, SceneChoice& choice);

/// Whether a file is a recorded frame; what cannot be read is none.
bool isRecordedFrame(const std::string& name);

/// Files by their formats, procedural scenes by their specifications; shows progress and notes. Errors name the file
/// and say what is wrong.
Result<Scene> loadScene(const SceneChoice& choice);
/// The same before it is split, and how it is to be.
Result<Scene> loadWholeScene(const SceneChoice& choice, Split& split);

}  // namespace sightline::cli
