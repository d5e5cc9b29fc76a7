// What the case "backface" measures on: made meshes and scenes, as one mesh each, and clusters of them.
// SPDX-License-Identifier: MIT
#include "bench/facing_meshes.h"

#include <algorithm>
#include <cmath>

#include <meshoptimizer.h>

#include "sightline/base/random.h"

namespace sightline::bench {
using namespace tools;

Box3d FacingMesh::box() const {
    Box3d box;
    for (const uint32_t index : indices) box.grow(glm::dvec3(positions[index]));
    return box;
}

FacingMesh bumpyBall(const std::string& name, int rings, double bumps, double noise) {
    FacingMesh mesh;
    mesh.name = name;
    Random random(3);
    const int columns = 2 * rings;
    // The poles are left out by a little, as a ring of their own: no triangle collapses.
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < columns; ++j) {
            const double a = glm::radians(180.0) * (i + 0.25) / (rings + 0.5);
            const double b = glm::radians(360.0) * j / columns;
            const double r = 1.0 + bumps * std::sin(7 * a) * std::cos(5 * b) + noise * random.uniform(-1, 1);
            const glm::dvec3 d(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
            mesh.positions.push_back(glm::vec3(r * d));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < columns; ++j) {
            const auto at = [&](int x, int y) { return static_cast<uint32_t>(x * columns + y % columns); };
            const uint32_t a = at(i, j), b = at(i, j + 1), c = at(i + 1, j), d = at(i + 1, j + 1);
            for (const uint32_t v : {a, b, c, c, b, d}) mesh.indices.push_back(v);
        }
    return mesh;
}

FacingMesh wholeScene(const Scene& scene) {
    FacingMesh out;
    out.name = scene.name;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const uint32_t first = static_cast<uint32_t>(out.positions.size());
        for (const glm::vec3& p : mesh.positions)
            out.positions.push_back(glm::vec3(object.transform * glm::dvec4(glm::dvec3(p), 1.0)));
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                            c = mesh.positions[mesh.indices[i + 2]];
            if (a == b || b == c || c == a) continue;
            out.indices.push_back(first + mesh.indices[i]);
            out.indices.push_back(first + mesh.indices[i + (mirrored ? 2 : 1)]);
            out.indices.push_back(first + mesh.indices[i + (mirrored ? 1 : 2)]);
        }
    }
    return out;
}

ClusteredMesh meshoptClusters(const FacingMesh& mesh, uint32_t triangles, float cone_weight) {
    constexpr size_t kVertices = 255;
    const size_t most = meshopt_buildMeshletsBound(mesh.indices.size(), kVertices, triangles);
    std::vector<meshopt_Meshlet> meshlets(most);
    std::vector<unsigned> vertices(most * kVertices);
    std::vector<unsigned char> corners(most * triangles * 3);
    meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), mesh.indices.data(),
                                          mesh.indices.size(), &mesh.positions[0].x, mesh.positions.size(),
                                          sizeof(glm::vec3), kVertices, triangles, cone_weight));
    ClusteredMesh out;
    out.mesh.name = mesh.name;
    out.mesh.positions = mesh.positions;
    for (const meshopt_Meshlet& meshlet : meshlets) {
        for (size_t i = 0; i < size_t{3} * meshlet.triangle_count; ++i)
            out.mesh.indices.push_back(vertices[meshlet.vertex_offset + corners[meshlet.triangle_offset + i]]);
        out.sizes.push_back(meshlet.triangle_count);
    }
    return out;
}

MeshoptCones::MeshoptCones(const ClusteredMesh& clustered) {
    size_t first = 0;
    for (const uint32_t size : clustered.sizes) {
        const meshopt_Bounds bounds = meshopt_computeClusterBounds(clustered.mesh.indices.data() + 3 * first,
                                                                   size_t{3} * size, &clustered.mesh.positions[0].x,
                                                                   clustered.mesh.positions.size(), sizeof(glm::vec3));
        Cone& cone = cones_.emplace_back();
        std::copy_n(bounds.cone_apex, 3, cone.apex);
        std::copy_n(bounds.cone_axis, 3, cone.axis);
        cone.cutoff = bounds.cone_cutoff;
        first += size;
    }
}

void MeshoptCones::find(const glm::dvec3& eye, std::vector<uint8_t>& back) const {
    std::fill(back.begin(), back.end(), uint8_t{0});
    for (size_t i = 0; i < cones_.size(); ++i) {
        const Cone& cone = cones_[i];
        float v[3], square = 0, along = 0;
        for (int axis = 0; axis < 3; ++axis) {
            v[axis] = cone.apex[axis] - static_cast<float>(eye[axis]);
            square += v[axis] * v[axis];
            along += v[axis] * cone.axis[axis];
        }
        if (along >= cone.cutoff * std::sqrt(square) && cone.cutoff < 1)
            back[i / 8] |= static_cast<uint8_t>(1u << i % 8);
    }
}

std::vector<FacingEye> randomEyes(const Box3d& box, int count) {
    Random random(4);
    std::vector<FacingEye> eyes;
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform(box.min.x, box.max.x), y = random.uniform(box.min.y, box.max.y);
        eyes.push_back({{x, y, random.uniform(box.min.z, box.max.z)}, 1.0, 0.0, FrontFace::kCounterClockwise});
    }
    return eyes;
}

}  // namespace sightline::bench
