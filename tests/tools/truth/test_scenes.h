// Small scenes made in code for the witnesses' tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/scene/scene.h"
#include "tests/support/meshes.h"

namespace sightline::test {
using namespace tools;

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
    TestMesh mesh = boxMesh(-half, half);
    return addMesh(scene, std::move(mesh.positions), std::move(mesh.indices), material);
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
