// Walks through a scene's free space, frame by frame as a player moves: what coherence is measured by.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/load/floor.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

struct WalkSettings {
    uint32_t frames = 600;
    uint64_t seed = 1;
    double fps = 60;     ///< frames a second  [> 0]
    double speed = 1.4;  ///< world units a second: a pedestrian's, where the unit is a metre  [>= 0]
};

/// A smooth path at the height of a person's eye over the floor that findFloor() finds, from room to room (wayOver()), and
/// back where it has been everywhere. Where there is no floor it flies: from a seeded camera to others that can be
/// reached in straight lines through free space, nearest first, and where none can be, towards open space.
///
/// Two frames in turn are no farther apart than speed / fps, their directions by no more than 60 degrees a second, and no
/// surface lies between their eyes. A flight keeps a margin from surfaces ahead: a quarter of a unit, at most a hundredth
/// of the scene's diagonal, and less where it is narrow; a walk a fifth of a metre. The camera looks ahead, and about,
/// where one sees far. Where there is no way on it stands.
///
/// The same on every machine. A scene without triangles is walked through from the origin.
CameraPath walkThrough(const Scene& scene, const WalkSettings& settings);

/// The same over a floor that is known already: that of findFloor() with the same seed.
CameraPath walkOver(const Scene& scene, const RayProbe& probe, const WalkFloor& floor, const WalkSettings& settings);

}  // namespace sightline::tools
