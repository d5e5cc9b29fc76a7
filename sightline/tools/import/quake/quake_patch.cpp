// Curved patches of Quake 3 as triangles.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_patch.h"

#include <algorithm>

namespace sightline::tools {
namespace {

constexpr uint32_t kSteps = 4;  // along each side of a patch of 3 x 3 control points

/// Quadratic, over each three of the points that share an end with the next three.
struct Weights {
    uint32_t first;
    double of[3];
};

Weights weightsAt(uint32_t step, uint32_t points) {
    const uint32_t part = std::min(step / kSteps, (points - 1) / 2 - 1);
    const double t = double(step - part * kSteps) / kSteps;
    return {2 * part, {(1 - t) * (1 - t), 2 * t * (1 - t), t * t}};
}

}  // namespace

void tessellatePatch(std::span<const glm::vec3> control, uint32_t width, uint32_t height, Mesh& mesh) {
    const uint32_t columns = (width - 1) / 2 * kSteps, rows = (height - 1) / 2 * kSteps;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column) {
            const Weights u = weightsAt(column, width), v = weightsAt(row, height);
            glm::dvec3 point(0);
            for (uint32_t j = 0; j < 3; ++j)
                for (uint32_t i = 0; i < 3; ++i)
                    point += u.of[i] * v.of[j] * glm::dvec3(control[size_t(v.first + j) * width + u.first + i]);
            mesh.positions.emplace_back(point);
        }
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * (columns + 1) + column, b = a + 1, c = a + columns + 1, d = c + 1;
            for (const uint32_t index : {a, b, d, a, d, c}) mesh.indices.push_back(index);
        }
    for (const glm::vec3& point : control) mesh.bounds.grow(glm::dvec3(point));
    for (const glm::vec3& point : mesh.positions) mesh.bounds.grow(glm::dvec3(point));
    mesh.deforms = true;
}

}  // namespace sightline::tools
