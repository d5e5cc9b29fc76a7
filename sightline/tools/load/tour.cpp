// The path of who asks for none: the whole of a scene first, then the way that suits it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/tour.h"

#include <algorithm>

#include "sightline/tools/load/floor.h"
#include "sightline/tools/load/orbit.h"
#include "sightline/tools/load/walk.h"

namespace sightline::tools {
namespace {

/// Between two frames, so that all of them see most of a floor  [world units].
double stepOver(const WalkFloor& floor, uint32_t frames) {
    const double area = floor.spacing * floor.spacing * static_cast<double>(floor.places.size());
    const double length = area / (2 * std::max(1.5 * floor.unit, 3 * floor.spacing));
    return std::clamp(length / frames, 0.4 * floor.unit, 10 * floor.spacing);
}

}  // namespace

CameraPath tourOf(const Scene& scene, uint32_t frames, uint64_t seed) {
    CameraPath path = overviewsOf(scene, std::min(frames, 1u), seed);
    if (frames < 2) return path;
    const RayProbe probe(scene);
    const WalkFloor floor = findFloor(scene, probe, seed);
    CameraPath rest;
    if (floor.places.empty()) {
        rest = orbitAround(scene, frames - 1, seed);
    } else {
        constexpr double kFps = 0.1;  // so few that there is time to turn around between two frames
        WalkSettings walk{.frames = frames - 1, .seed = seed, .fps = kFps};
        walk.speed = kFps * stepOver(floor, walk.frames);
        rest = walkOver(scene, probe, floor, walk);
    }
    path.frames.insert(path.frames.end(), rest.frames.begin(), rest.frames.end());
    return path;
}

}  // namespace sightline::tools
