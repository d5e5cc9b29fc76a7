// A procedural city: streets, buildings with recesses, street furniture.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/city.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sightline/tools/scene/city/blocks.h"
#include "sightline/tools/scene/city/layout.h"
#include "sightline/tools/scene/city/library.h"

namespace sightline::tools {
namespace {

constexpr double kEyeHeight = 1.7;  // [metres]
constexpr double kTurn = 6;         // how far from a corner the walk begins to turn  [metres]
constexpr double kGlance = 0.25;    // the tangent by which the walker looks towards the market on the left

struct Step {
    glm::dvec2 at, heading;
};

/// The walk is a loop along the middle of the streets around the central block, which lies to the left:
/// each street ahead ends at the corner where the walk turns. One unit is one side.
Step stepAt(double progress) {
    const int quarter = static_cast<int>(progress) % 4;
    const double along = (progress - std::floor(progress)) * city::kLargeBlock, half = 0.5 * city::kLargeBlock;
    const city::Side side = city::sideOf({{-half, -half}, {half, half}}, quarter);
    const glm::dvec2 forward = city::alongSide(quarter), right = city::outwardOf(quarter);
    if (along > side.length - kTurn) {  // the first half of a turn: a parabola around the corner
        const double u = 0.5 * (along - (side.length - kTurn)) / kTurn;
        return {side.at(side.length - kTurn * (1 - u) * (1 - u), -kTurn * u * u), forward * (1 - u) - right * u};
    }
    if (along < kTurn) {  // the second half of the turn before
        const double u = 0.5 + 0.5 * along / kTurn;
        return {side.at(kTurn * u * u, -kTurn * (1 - u) * (1 - u)), forward * u + right * (1 - u)};
    }
    return {side.at(along, 0), forward};
}

/// A wave from -1 to 1 with period 1, made of parabolas.
double sway(double phase) {
    const double t = phase - std::floor(phase), u = t < 0.5 ? 2 * t : 2 * t - 1;
    return (t < 0.5 ? 4 : -4) * u * (1 - u);
}

}  // namespace

Scene makeCity(uint64_t seed, uint32_t objects) {
    Scene scene;
    scene.name = "city:" + std::to_string(seed) + ":" + std::to_string(objects);
    city::Library library = city::makeLibrary(seed);
    constexpr size_t kLargestBlock = 512;  // more than any block holds, so that the list never moves
    scene.objects.reserve(objects + kLargestBlock);
    city::Planter planter(scene.objects);
    city::BlockSequence blocks;
    while (scene.objects.size() < objects) city::fillBlock(library, seed, blocks.next(), planter);
    scene.objects.resize(objects);
    scene.materials = std::move(library.materials);
    scene.meshes = std::move(library.meshes);
    return scene;
}

CameraPath cityStreetPath(uint64_t seed, uint32_t frames) {
    Random random(mixSeed(seed, 0x77616c6bull));
    const double start = random.uniform(0, 4);
    const double pan = random.uniform(0.1, 0.2);
    const double phase = random.uniform();
    CameraPath path;
    path.frames.resize(frames);
    for (uint32_t i = 0; i < frames; ++i) {
        const double share = static_cast<double>(i) / frames, progress = 4 * share + start;
        const Step step = stepAt(progress >= 4 ? progress - 4 : progress);
        const glm::dvec2 ahead = step.heading / glm::length(step.heading), aside(-ahead.y, ahead.x);
        const glm::dvec2 look = ahead + aside * (pan * sway(7 * share + phase) - kGlance);
        CameraFrame& frame = path.frames[i];
        frame.eye = {step.at.x, kEyeHeight, step.at.y};
        frame.target = {step.at.x + 10 * look.x, kEyeHeight + 0.5, step.at.y + 10 * look.y};
    }
    return path;
}

}  // namespace sightline::tools
