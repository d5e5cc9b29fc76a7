// One number for all that a scene consists of, so that a test can pin it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <string>

#include "sightline/tools/scene/scene.h"

namespace sightline {
using namespace tools;

/// FNV-1a over the bits of everything that is drawn, named or declared.
class SceneHash {
public:
    template <class T>
    void add(const T& value) {
        unsigned char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        for (const unsigned char byte : bytes) state_ = (state_ ^ byte) * 0x100000001b3ull;
    }
    void add(const std::string& text) {
        for (const char letter : text) add(letter);
        add(text.size());
    }
    uint64_t value() const { return state_; }

private:
    uint64_t state_ = 0xcbf29ce484222325ull;
};

inline uint64_t hashOfScene(const Scene& scene) {
    SceneHash hash;
    for (const Material& material : scene.materials) {
        for (int c = 0; c < 4; ++c) hash.add(material.base_color[c]);
        hash.add(material.alpha_mode);
        hash.add(material.double_sided);
    }
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& p : mesh.positions)
            for (int axis = 0; axis < 3; ++axis) hash.add(p[axis]);
        for (const uint32_t index : mesh.indices) hash.add(index);
        for (const Primitive& primitive : mesh.primitives) {
            hash.add(primitive.triangle_count);
            hash.add(primitive.material);
        }
    }
    for (const SceneObject& object : scene.objects) {
        hash.add(object.key);
        hash.add(object.mesh);
        hash.add(object.node);
        hash.add(object.name);
        for (int i = 0; i < 16; ++i) hash.add(object.transform[i / 4][i % 4] + 0.0);
    }
    for (const SceneNode& node : scene.nodes) {
        hash.add(node.name);
        hash.add(node.parent);
    }
    for (const SceneCell& cell : scene.cells) {
        hash.add(cell.name);
        for (const glm::dvec4& plane : cell.planes)
            for (int i = 0; i < 4; ++i) hash.add(plane[i] + 0.0);
    }
    for (const ScenePortal& portal : scene.portals) {
        hash.add(portal.cells[0]);
        hash.add(portal.cells[1]);
        hash.add(portal.door);
        for (const glm::dvec3& corner : portal.polygon)
            for (int i = 0; i < 3; ++i) hash.add(corner[i]);
    }
    for (const SceneCamera& camera : scene.cameras) {
        hash.add(camera.name);
        for (int i = 0; i < 16; ++i) hash.add(camera.transform[i / 4][i % 4] + 0.0);
    }
    return hash.value();
}

}  // namespace sightline
