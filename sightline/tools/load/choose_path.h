// The path that a run uses: from a file, made, or the scene's own.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

enum class PathKind {
    kAny,      ///< none was asked for
    kScatter,  ///< seededCameras()
    kWalk,     ///< walkThrough()
};

struct PathChoice {
    std::string file;  ///< empty: none
    PathKind kind = PathKind::kAny;
    WalkSettings walk{.frames = 0};  ///< frames and seed are any kind's; 0 frames: not asked for
};

/// The file's cameras; else those of a kind, 16 scattered ones or a walk of 600 frames if nothing says how many; else,
/// if no frames were asked for either, the scene's own; else scattered ones. Errors: of readCameraPath().
Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice);

}  // namespace sightline::tools
