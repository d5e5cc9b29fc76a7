// What a scene draws, whatever its objects are: all triangles in the world, each with its material.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "sightline/tools/scene/scene.h"

namespace sightline::test {
using namespace tools;

using WorldCorner = std::array<double, 3>;
/// Its material's name, colour and mode, and its corners in their order.
using DrawnTriangle =
    std::tuple<std::string, std::array<float, 4>, AlphaMode, bool, WorldCorner, WorldCorner, WorldCorner>;

/// All of them, sorted.
inline std::vector<DrawnTriangle> trianglesDrawn(const Scene& scene) {
    std::vector<DrawnTriangle> out;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        for (const Primitive& primitive : mesh.primitives) {
            const Material& m = scene.materials[primitive.material];
            for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
                const auto corner = [&](uint32_t k) {
                    const glm::vec3& p = mesh.positions[mesh.indices[3 * t + k]];
                    const glm::dvec4 world = object.transform * glm::dvec4(p, 1);
                    return WorldCorner{world.x, world.y, world.z};
                };
                const std::array<float, 4> color = {m.base_color.x, m.base_color.y, m.base_color.z, m.base_color.w};
                out.emplace_back(m.name, color, m.alpha_mode, m.double_sided, corner(0), corner(1), corner(2));
            }
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace sightline::test
