// A scene that has everything that a stream can hold, and its stream.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::test {
using namespace tools;

inline Scene sampleScene() {
    Scene scene;
    scene.materials.push_back({"grey", {0.5f, 0.25f, 0.125f, 1}, AlphaMode::kOpaque, 0.5f, false, false});
    scene.materials.push_back({"glass", glm::vec4(1), AlphaMode::kBlend, 0.5f, true, true});
    scene.nodes = {{"House", SceneNode::kNone}, {"Room", 0}, {"", 1}};
    scene.meshes.push_back({"first mesh", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}, {{0, 1, 0}}, {}, {}, false});
    scene.meshes.push_back({"moves",
                            {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            {0, 1, 2, 0, 2, 3},
                            {{0, 1, 0}, {1, 1, 1}},
                            {},
                            {glm::dvec3(-9), glm::dvec3(9)},
                            true});
    glm::dmat4 moved(1.0);
    moved[3] = {1, 2, 3, 1};
    scene.objects = {{0, 0, glm::dmat4(1.0), "Door", 1}, {1, 1, moved, "Cat", 2}, {2, 0, moved, "", 0}};
    scene.cameras.push_back({"eye", moved, 1, 0, 0.5, 100});
    scene.cameras.push_back({"plan", moved, 0, 20, 0.5, {}});
    scene.rooms = {{1, {glm::dvec3(-1), glm::dvec3(2)}}, {0, {}}};
    return scene;
}

inline std::string streamOf(const Scene& scene) {
    std::string out;
    SceneStreamWriter writer(
        [&](const void* bytes, size_t size) { out.append(static_cast<const char*>(bytes), size); });
    writer.progress(1, 2);
    for (const Material& material : scene.materials) writer.material(material);
    for (const SceneNode& node : scene.nodes) writer.node(node);
    for (const Mesh& mesh : scene.meshes) writer.mesh(mesh);
    for (const SceneObject& object : scene.objects) writer.object(object);
    for (const SceneCamera& camera : scene.cameras) writer.camera(camera);
    for (const SceneRoom& room : scene.rooms) writer.room(room);
    writer.part("the last part");
    writer.note("something");
    writer.end();
    return out;
}

}  // namespace sightline::test
