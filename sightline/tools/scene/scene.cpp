// A scene as plain data: what an importer fills and what a world, a renderer or a witness reads.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/scene.h"

#include <string_view>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {

uint64_t drawnTriangles(const Scene& scene) {
    uint64_t count = 0;
    for (const SceneObject& object : scene.objects) count += scene.meshes[object.mesh].triangles();
    return count;
}

Box3d worldBounds(const Scene& scene) {
    Box3d bounds;
    for (const SceneObject& object : scene.objects)
        bounds.grow(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    return bounds;
}

WideObjects wideObjects(const Scene& scene) {
    const double half = glm::length(worldBounds(scene).size()) / 2;
    WideObjects wide;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        if (mesh.deforms || !(glm::length(transformBox(mesh.bounds, object.transform).size()) > half)) continue;
        wide.triangles += mesh.triangles();
        ++wide.objects;
    }
    return wide;
}

std::string objectPath(const Scene& scene, const SceneObject& object) {
    if (object.name.size() > kLongestPath) return shortened(object.name, kLongestPath);
    constexpr std::string_view kMore = ".../";
    std::vector<const std::string*> names;
    if (!object.name.empty()) names.push_back(&object.name);
    size_t length = object.name.size();
    std::string path;
    for (uint32_t node = object.node; node != SceneNode::kNone; node = scene.nodes[node].parent) {
        const std::string& name = scene.nodes[node].name;
        if (name.empty() || (node == object.node && name == object.name)) continue;
        if (length + 1 + name.size() + kMore.size() > kLongestPath) {
            path = kMore.substr(0, kMore.size() - 1);
            break;
        }
        length += 1 + name.size();
        names.push_back(&name);
    }
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
        if (!path.empty()) path += '/';
        path += **name;
    }
    return path;
}

std::string roomPath(const Scene& scene, const SceneRoom& room) {
    SceneObject object;
    object.node = room.node;
    return objectPath(scene, object);
}

}  // namespace sightline::tools
