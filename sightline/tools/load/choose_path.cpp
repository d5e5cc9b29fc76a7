// The path that a run uses: from a file, made, or the scene's own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/choose_path.h"

#include "sightline/tools/load/orbit.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/tour.h"

namespace sightline::tools {

bool takesOwnCameras(const Scene& scene, const PathChoice& choice) {
    return choice.file.empty() && choice.kind == PathKind::kAny && choice.walk.frames == 0 && !choice.seeded &&
           !scene.cameras.empty();
}

Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice) {
    constexpr uint32_t kFrames = 16;
    if (!choice.file.empty()) return readCameraPath(choice.file);
    if (takesOwnCameras(scene, choice)) return sceneCameras(scene);
    WalkSettings walk = choice.walk;
    const auto framesOr = [&](uint32_t usual) { return walk.frames > 0 ? walk.frames : usual; };
    switch (choice.kind) {
        case PathKind::kWalk:
            walk.frames = framesOr(WalkSettings().frames);
            return walkThrough(scene, walk);
        case PathKind::kOrbit:
            return orbitAround(scene, framesOr(kFrames), walk.seed);
        case PathKind::kOverview:
            return overviewsOf(scene, framesOr(1), walk.seed);
        case PathKind::kScatter:
            return seededCameras(scene, framesOr(kFrames), walk.seed);
        case PathKind::kAny:
        case PathKind::kTour:
            break;
    }
    return tourOf(scene, framesOr(kFrames), walk.seed);
}

}  // namespace sightline::tools
