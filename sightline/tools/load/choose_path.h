// The path that a run uses: from a file, made, or the scene's own.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "sightline/base/result.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

enum class PathKind {
    kAny,       ///< none was asked for
    kTour,      ///< tourOf()
    kWalk,      ///< walkThrough()
    kOrbit,     ///< orbitAround()
    kOverview,  ///< overviewsOf()
    kScatter,   ///< seededCameras()
};

struct PathChoice {
    std::string file;                     ///< empty: none
    std::optional<glm::dvec3> eye, look;  ///< one camera; without `look` it looks at the middle of the core (SceneCore)
    PathKind kind = PathKind::kAny;
    bool seeded = false;             ///< a seed was asked for
    WalkSettings walk{.frames = 0};  ///< frames and seed are any kind's; 0 frames: not asked for
    bool speed_given = false;        ///< the walk's speed was asked for; else it is the scene's own, if it has one
};

/// Whether nothing else was asked for and the scene has cameras, so that choosePath() takes those.
bool takesOwnCameras(const Scene& scene, const PathChoice& choice);

/// The file's cameras; else the one of `eye`; else those of a kind; else, if neither frames nor a seed were asked for, the scene's own; else a
/// tour. If nothing says how many: 600 of a walk, one overview, 16 of the others. Errors: of readCameraPath().
Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice);

}  // namespace sightline::tools
