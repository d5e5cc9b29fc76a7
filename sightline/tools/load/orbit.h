// Cameras around a scene that show the whole of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Once around the scene, or its core (SceneCore), in so many frames, from a seeded side on, at one distance, 17 degrees above the horizon. All of
/// the scene is in each image of 3 by 2 or wider. Vertical angle 45 degrees, near a thousandth of the distance to the
/// centre, infinite far. A scene without triangles is orbited as if it were a unit cube at the origin.
CameraPath orbitAround(const Scene& scene, uint32_t frames, uint64_t seed);

/// Views of the whole from seeded sides, 30 degrees above the horizon, otherwise the same: each as near as its own side
/// lets it be.
CameraPath overviewsOf(const Scene& scene, uint32_t frames, uint64_t seed);

}  // namespace sightline::tools
