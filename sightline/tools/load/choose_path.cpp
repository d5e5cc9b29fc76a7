// The path that a run uses: from a file, made, or the scene's own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/choose_path.h"

#include "sightline/tools/load/seeded_cameras.h"

namespace sightline::tools {

Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice) {
    constexpr uint32_t kScattered = 16;
    if (!choice.file.empty()) return readCameraPath(choice.file);
    WalkSettings walk = choice.walk;
    if (choice.kind == PathKind::kWalk) {
        if (walk.frames == 0) walk.frames = WalkSettings().frames;
        return walkThrough(scene, walk);
    }
    if (choice.kind == PathKind::kAny && walk.frames == 0 && !scene.cameras.empty()) return sceneCameras(scene);
    return seededCameras(scene, walk.frames > 0 ? walk.frames : kScattered, walk.seed);
}

}  // namespace sightline::tools
