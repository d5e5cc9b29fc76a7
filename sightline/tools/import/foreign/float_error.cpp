// What is lost of a scene's coordinates where a reader holds them as 32-bit numbers.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/foreign/float_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

constexpr double kHalfStep = 0x1p-24;  // of a float, at most: half of its last place
constexpr double kTold = 1e-3;         // [metres]

/// No coordinate of a vertex or of a place is larger. Vertices count before they are moved: a place that brings them back
/// to the origin brings back no digits.
double largestCoordinate(const Scene& scene) {
    std::vector<glm::dvec3> sizes;
    for (const Mesh& mesh : scene.meshes) {
        glm::vec3 size(0.0f);
        for (const glm::vec3& position : mesh.positions) size = glm::max(size, glm::abs(position));
        sizes.emplace_back(size);
    }
    glm::dvec3 largest(0.0);
    for (const SceneObject& object : scene.objects) {
        const glm::dmat3 turn(object.transform);
        const glm::dmat3 reach(glm::abs(turn[0]), glm::abs(turn[1]), glm::abs(turn[2]));
        largest = glm::max(largest, reach * sizes[object.mesh]);
        largest = glm::max(largest, glm::abs(glm::dvec3(object.transform[3])));
    }
    return std::max({largest.x, largest.y, largest.z});
}

}  // namespace

std::string floatErrorText(const Scene& scene, double scale) {
    const double error = kHalfStep * scale * largestCoordinate(scene);
    if (!(error > kTold)) return {};
    const std::string size =
        error < 1 ? fmt::format("{:.0f} mm", std::ceil(1e3 * error)) : fmt::format("{:.1f} m", error);
    return fmt::format(
        "points may be off by up to {}: coordinates reach {:.0f} km, and this format is read in 32-bit numbers. "
        "Move the model near the origin, or export it as glTF",
        size, error / kHalfStep / 1e3);
}

}  // namespace sightline::tools
