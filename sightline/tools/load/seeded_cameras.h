// Seeded cameras that stand near surfaces and look at front faces, as a visitor would.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// A camera stands off a surface point chosen by area (0.3 to 6 % of the scene's diagonal along the
/// normal), looks anywhere with pitch within +-30 degrees, and is taken only if most of its rays meet
/// front faces at more than 0.2 % of the diagonal; the wish fades if a scene cannot meet it.
/// Deterministic in (scene, count, seed); a scene without triangles gives cameras around the origin.
/// Vertical angle 60 degrees, near 0.05 % of the diagonal but at most 0.1, infinite far.
CameraPath seededCameras(const Scene& scene, uint32_t count, uint64_t seed);

/// The path that a run uses: --cameras, else --frames/--seed, else the scene's own, else 16 seeded.
struct PathChoice {
    std::string file;     ///< empty: none
    uint32_t frames = 0;  ///< 0: not asked for
    uint64_t seed = 1;
};
Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice);

}  // namespace sightline::tools
