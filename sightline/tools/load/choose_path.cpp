// The path that a run uses: from a file, made, or the scene's own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/choose_path.h"

#include <algorithm>
#include <cmath>

#include "sightline/tools/load/orbit.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/tour.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {

namespace {

CameraFrame cameraAt(const Scene& scene, const glm::dvec3& eye, const std::optional<glm::dvec3>& look) {
    const SceneCore core = coreOf(scene);
    CameraFrame frame;
    frame.eye = eye;
    frame.target = look.value_or(core.bounds.empty() ? glm::dvec3(0.0) : core.bounds.center());
    glm::dvec3 ahead = frame.target - eye;
    if (!(glm::length(ahead) > 0)) frame.target = eye + (ahead = glm::dvec3(0, 0, -1));
    if (std::abs(ahead.y) > 0.999 * glm::length(ahead)) frame.up = {0, 0, -1};  // up or down
    if (core.diagonal() > 0) frame.z_near = std::min(0.0005 * core.diagonal(), 0.1);
    return frame;
}

}  // namespace

bool takesOwnCameras(const Scene& scene, const PathChoice& choice) {
    return choice.file.empty() && !choice.eye && choice.kind == PathKind::kAny && choice.walk.frames == 0 &&
           !choice.seeded && !scene.cameras.empty();
}

Result<CameraPath> choosePath(const Scene& scene, const PathChoice& choice) {
    constexpr uint32_t kFrames = 16;
    if (!choice.file.empty()) return readCameraPath(choice.file);
    if (choice.eye) return CameraPath{{cameraAt(scene, *choice.eye, choice.look)}};
    if (takesOwnCameras(scene, choice)) return sceneCameras(scene);
    WalkSettings walk = choice.walk;
    const auto framesOr = [&](uint32_t usual) { return walk.frames > 0 ? walk.frames : usual; };
    switch (choice.kind) {
        case PathKind::kWalk:
            walk.frames = framesOr(WalkSettings().frames);
            if (!choice.speed_given && scene.walk_speed > 0) walk.speed = scene.walk_speed;
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
