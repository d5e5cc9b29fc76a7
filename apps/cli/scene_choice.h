// Which scene a verb is to look at: files or a procedural one, and how files are read.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/scene/scene.h"

namespace CLI {
class App;
}

namespace sightline::cli {

struct SceneChoice {
    std::vector<std::string> names;  ///< files, or one procedural scene

    /// For a reader: "a.glb + b.glb".
    std::string title() const;
    /// As a shell takes it, with the options that differ from their defaults.
    std::string words() const;
    /// The one procedural scene's specification, or empty.
    std::string procedural() const;
};

/// SCENE and the options of importing.
void addSceneChoice(CLI::App& verb, SceneChoice& choice);

/// Files by their formats, or a procedural scene by its specification; shows progress. Errors name the file and say
/// what is wrong.
Result<Scene> loadScene(const SceneChoice& choice);

}  // namespace sightline::cli
