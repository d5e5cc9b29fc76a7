// Reads a scene from a file of any format that is known, and joins scenes of several files.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/scene/scene.h"

namespace sightline {

/// The axis of a file that points up. Sightline's is y, with z towards the viewer.
enum class UpAxis : uint8_t { kAsFileSays, kX, kY, kZ };

/// Which sides of surfaces are drawn.
enum class Sides : uint8_t {
    kAsFileSays,  ///< by the file's materials; both, where its format does not tell
    kOne,         ///< the front alone, whatever the file says: for renderers that leave out back faces
    kBoth,        ///< both, whatever the file says
};

struct ImportSettings {
    UpAxis up = UpAxis::kAsFileSays;  ///< a scene is turned so that this axis becomes y
    double scale = 1;                 ///< positions are multiplied with it  [> 0]
    Sides sides = Sides::kAsFileSays;
    uint64_t memory_limit = uint64_t(8) << 30;  ///< for readers that are not ours  [bytes]
    double time_limit = 300;                    ///< for readers that are not ours  [seconds]
    std::string worker;                         ///< the program sightline-import; empty: beside the running program,
                                                ///< or where it was installed
    std::function<void(size_t done, size_t total)> progress;  ///< may be empty; any unit
    std::function<void(const std::string& text)>
        note;  ///< what the user should know of a scene that was read; may be empty
};

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

}  // namespace sightline
