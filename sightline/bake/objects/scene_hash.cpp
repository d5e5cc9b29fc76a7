// Hashes a scene number by number, in blocks.
// SPDX-License-Identifier: MIT
#include "sightline/bake/objects/scene_hash.h"

#include "sightline/base/bytes.h"
#include "sightline/base/random.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// Numbers, hashed part by part.
class Hash {
public:
    template <class T>
    void put(T value) {
        ByteWriter(bytes_).put(value);
        if (bytes_.size() >= 65536) end();
    }
    template <class Vector>
    void putAll(const Vector& vector, int count) {
        for (int i = 0; i < count; ++i) put(vector[i]);
    }
    uint64_t end() {
        hash_ = mixSeed(hash_, contentHash(bytes_));
        bytes_.clear();
        return hash_;
    }

private:
    Array<char> bytes_;
    uint64_t hash_ = 0;
};

}  // namespace

uint64_t hashOf(const Scene& scene) {
    Hash hash;
    for (const Mesh& mesh : scene.meshes) {
        hash.put(uint64_t{mesh.positions.size()});
        for (const glm::vec3& point : mesh.positions) hash.putAll(point, 3);
        hash.put(uint64_t{mesh.indices.size()});
        for (const uint32_t index : mesh.indices) hash.put(index);
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = scene.materials[primitive.material];
            hash.put(primitive.triangle_count);
            hash.put(static_cast<uint8_t>(2 * material.hides() + material.double_sided));
        }
        hash.put(static_cast<uint8_t>(mesh.deforms));
    }
    for (const SceneObject& object : scene.objects) {
        hash.put(object.key);
        hash.put(object.mesh);
        for (int column = 0; column < 4; ++column) hash.putAll(object.transform[column], 4);
    }
    for (const SceneCell& cell : scene.cells) {
        hash.put(uint64_t{cell.planes.size()});
        for (const glm::dvec4& plane : cell.planes) hash.putAll(plane, 4);
    }
    for (const ScenePortal& portal : scene.portals) {
        hash.putAll(portal.cells, 2);
        hash.put(portal.door);
        hash.put(uint64_t{portal.polygon.size()});
        for (const glm::dvec3& point : portal.polygon) hash.putAll(point, 3);
    }
    return hash.end();
}

}  // namespace sightline::bake
