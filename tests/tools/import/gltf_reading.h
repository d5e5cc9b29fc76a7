// How tests read glTF bytes and compare what comes out.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gltf_check.h"
#include "gltf_samples.h"
#include "sightline/tools/import/gltf/gltf.h"

namespace sightline::test {
using namespace tools;

using Corners = std::vector<glm::dvec3>;

inline Result<Scene> parse(const std::string& bytes) {
    return parseGltf(std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()), "test.glb");
}

/// The scene in a file's bytes, which must be sound.
inline Scene load(const std::string& bytes) {
    const Result<Scene> scene = parse(bytes);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    if (!scene.ok()) return {};
    EXPECT_EQ(sceneFault(*scene), "");
    return *scene;
}

inline Scene loadSample(const std::string& name) {
    SCOPED_TRACE(name);
    return load(gltfSample(name));
}

/// The corners of an object's triangles in the world.
inline Corners cornersOf(const Scene& scene, size_t object) {
    Corners out;
    if (object >= scene.objects.size()) return out;
    const Mesh& mesh = scene.meshes[scene.objects[object].mesh];
    for (const uint32_t index : mesh.indices)
        out.emplace_back(scene.objects[object].transform * glm::dvec4(glm::dvec3(mesh.positions[index]), 1));
    return out;
}

/// The bounds of an object in the world.
inline Box3d boundsOf(const Scene& scene, size_t object) {
    if (object >= scene.objects.size()) return {};
    return transformBox(scene.meshes[scene.objects[object].mesh].bounds, scene.objects[object].transform);
}

inline void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double most, const char* what) {
    EXPECT_LE(glm::length(actual - expected), most)
        << what << " is (" << actual.x << ", " << actual.y << ", " << actual.z << "), not (" << expected.x << ", "
        << expected.y << ", " << expected.z << ")";
}

inline void expectCorners(const Corners& actual, const Corners& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t i = 0; i < actual.size(); ++i)
        expectNear(actual[i], expected[i], 1e-6, ("corner " + std::to_string(i)).c_str());
}

}  // namespace sightline::test
