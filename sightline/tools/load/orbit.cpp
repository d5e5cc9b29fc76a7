// Cameras around a scene that show the whole of it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/orbit.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/random.h"
#include "sightline/tools/scene/framing.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGolden = 2.39996323;  // between two sides in turn: no two of many are close  [radians]
constexpr size_t kMostBoxes = 65536;    // of more objects only the box around all is framed

Framing framingOf(const Scene& scene) {
    const SceneCore core = coreOf(scene);
    Box3d bounds = core.bounds;
    const bool nothing = !(core.diagonal() > 0);
    if (nothing) {
        bounds = {};
        bounds.grow(glm::dvec3(-0.5));
        bounds.grow(glm::dvec3(0.5));
    }
    Framing framing(bounds.center());
    if (nothing || scene.objects.size() > kMostBoxes || !core.isWhole()) framing.add(bounds);
    else
        for (const SceneObject& object : scene.objects)
            framing.add(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    return framing;
}

/// Between two faces of the box, where both are seen.
double seededSide(uint64_t seed) {
    Random random(mixSeed(seed, 0x73696465));
    const auto quarter = static_cast<double>(random.below(4));
    return kPi / 2 * quarter + random.uniform(0.15, 0.35) * kPi;
}

}  // namespace

CameraPath orbitAround(const Scene& scene, uint32_t frames, uint64_t seed) {
    constexpr double kElevation = 0.3;
    const Framing framing = framingOf(scene);
    const double first = seededSide(seed);
    double distance = 0;
    for (int i = 0; i < 64; ++i) distance = std::max(distance, framing.distanceFrom(sideAt(kPi / 32 * i, kElevation)));
    CameraPath path;
    for (uint32_t i = 0; i < frames; ++i) {
        const glm::dvec3 side = sideAt(first + 2 * kPi * i / frames, kElevation);
        path.frames.push_back(Framing::at(framing.center(), side, distance));
    }
    return path;
}

CameraPath overviewsOf(const Scene& scene, uint32_t frames, uint64_t seed) {
    constexpr double kElevation = kPi / 6;
    const Framing framing = framingOf(scene);
    CameraPath path;
    for (uint32_t i = 0; i < frames; ++i)
        path.frames.push_back(framing.nearest(sideAt(seededSide(seed) + kGolden * i, kElevation)));
    return path;
}

}  // namespace sightline::tools
