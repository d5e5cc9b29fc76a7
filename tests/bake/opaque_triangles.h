// The opaque triangles of a scene, tried one by one: what a ray meets.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/scene/scene.h"

namespace sightline::test {
using namespace tools;

class OpaqueTriangles {
public:
    explicit OpaqueTriangles(const Scene& scene) {
        for (uint32_t i = 0; i < scene.objects.size(); ++i) {
            const SceneObject& object = scene.objects[i];
            const Mesh& mesh = scene.meshes[object.mesh];
            for (size_t t = 0; t < mesh.triangles(); ++t) {
                Triangle triangle;
                triangle.object = i;
                triangle.both = scene.materials[mesh.primitives[0].material].double_sided;
                if (!scene.materials[mesh.primitives[0].material].hides()) continue;
                for (size_t c = 0; c < 3; ++c)
                    triangle.corners[c] = glm::dvec3(
                        object.transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * t + c]]), 1));
                const auto& [a, b, c] = triangle.corners;
                if (glm::length(glm::cross(b - a, c - a)) > 0)
                    all_.push_back(triangle);  // without area it hides nothing
            }
        }
    }

    /// Whether an opaque front, grown by `room`, is met between two distances.
    /// @param except  an object that does not count
    bool meets(const glm::dvec3& from, const glm::dvec3& along, double first, double last, double room,
               uint32_t except = ~0u) const {
        return std::any_of(all_.begin(), all_.end(), [&](const Triangle& triangle) {
            if (triangle.object == except) return false;
            const auto& [a, b, c] = triangle.corners;
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            const double towards = glm::dot(normal, along);
            if (towards == 0 || (towards > 0 && !triangle.both)) return false;
            const double t = glm::dot(normal, a - from) / towards;
            if (t < first || t > last) return false;
            const glm::dvec3 point = from + t * along;
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 edge = triangle.corners[(i + 1) % 3] - triangle.corners[i];
                if (glm::dot(glm::cross(normal, edge), point - triangle.corners[i]) < -room * glm::length(edge))
                    return false;
            }
            return true;
        });
    }

private:
    struct Triangle {
        glm::dvec3 corners[3];
        uint32_t object = 0;
        bool both = false;
    };
    std::vector<Triangle> all_;
};

}  // namespace sightline::test
