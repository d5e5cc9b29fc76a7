// Walks through a scene's free space, frame by frame as a player moves: what coherence is measured by.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

struct WalkSettings {
    uint32_t frames = 600;
    uint64_t seed = 1;
    double fps = 60;     ///< frames a second  [> 0]
    double speed = 1.4;  ///< world units a second: a pedestrian's, where the unit is a metre  [>= 0]
};

/// A smooth path from a seeded camera to others that can be reached in straight lines through free space, nearest
/// first; where none can be, towards open space. Two frames in turn are no farther apart than speed / fps, their
/// directions by no more than 60 degrees a second, and no surface lies between their eyes. The way keeps a margin from
/// surfaces that lie ahead: a quarter of a unit, but at most a hundredth of the scene's diagonal, and less where it is
/// narrow. The camera looks where it goes, and about. Where there is no way on it stands, and looks about.
///
/// The same on every machine. A scene without triangles is walked through from the origin.
CameraPath walkThrough(const Scene& scene, const WalkSettings& settings);

}  // namespace sightline::tools
