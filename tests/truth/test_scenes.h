// Small scenes made in code for the witnesses' tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/scene/scene.h"

namespace sightline::test {

inline glm::dmat4 moved(const glm::dvec3& by) {
    glm::dmat4 transform(1.0);
    transform[3] = glm::dvec4(by, 1.0);
    return transform;
}

/// Materials 0: opaque, 1: double-sided, 2: masked, 3: blended, 4: transmissive.
inline Scene emptyScene() {
    Scene scene;
    scene.materials.resize(5);
    scene.materials[1].double_sided = true;
    scene.materials[2].alpha_mode = AlphaMode::kMask;
    scene.materials[3].alpha_mode = AlphaMode::kBlend;
    scene.materials[4].transmissive = true;
    return scene;
}

inline uint32_t addMesh(Scene& scene, std::vector<glm::vec3> positions, std::vector<uint32_t> indices,
                        uint32_t material = 0) {
    Mesh mesh;
    for (const glm::vec3& p : positions) mesh.bounds.grow(glm::dvec3(p));
    mesh.positions = std::move(positions);
    mesh.indices = std::move(indices);
    mesh.primitives = {{0, static_cast<uint32_t>(mesh.triangles()), material}};
    scene.meshes.push_back(std::move(mesh));
    return static_cast<uint32_t>(scene.meshes.size() - 1);
}

/// A closed box around the origin, outside in front.
inline uint32_t addBox(Scene& scene, const glm::vec3& half, uint32_t material = 0) {
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 8; ++i)
        positions.emplace_back(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
    return addMesh(scene, std::move(positions), {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5},
                   material);
}

/// A square in the plane z = 0 that faces +z.
inline uint32_t addSquare(Scene& scene, float half, uint32_t material = 0) {
    return addMesh(scene, {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {0, 1, 2, 0, 2, 3},
                   material);
}

inline uint32_t addObject(Scene& scene, uint32_t mesh, const glm::dmat4& transform) {
    SceneObject object;
    object.key = scene.objects.size();
    object.mesh = mesh;
    object.transform = transform;
    scene.objects.push_back(object);
    return static_cast<uint32_t>(scene.objects.size() - 1);
}

}  // namespace sightline::test
