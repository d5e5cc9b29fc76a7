// Reads a scene from a file of any format that is known, and joins scenes of several files.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/import/import_settings.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// glTF by our own reader; what else Assimp reads by sightline-import, a process with limits of its own. What a file
/// is, its first bytes decide where they are sure, else its suffix. docs/formats.md says what is taken from each format.
/// May be called from several threads at once.
///
/// Errors (kInput) are one line with the file's name: no such file; a directory; an archive or a compressed file, which
/// is to be unpacked first; a format that is not read, with what to export instead; and what the readers find.
Result<Scene> loadSceneFile(const std::string& file, const ImportSettings& settings = {});

/// Turns and scales all of a scene: the settings' up, scale and sides. Objects are moved by their transforms, so that
/// meshes stay as they are.
void placeScene(Scene& scene, const ImportSettings& settings);

/// One scene of several, in their order. Keys of the second and later ones are raised so that none repeats; Scene::files
/// tells by how much. Its name is their names, joined by " + ". Each scene's nodes hang in a node of their own, named as
/// its file is, without folders and suffix. A single scene is given back as it is.
/// @param scenes  [size: >= 1]
Scene joinScenes(std::vector<Scene> scenes);

}  // namespace sightline::tools
