// Prepared meshes for tests: tori with all that can be prepared of them, and less.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/prepare/inner/inner.h"
#include "sightline/prepare/lod/lod_chain.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/visfile/prepared_section.h"

namespace sightline::test {

struct Torus {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;

    Torus(uint32_t around, uint32_t across) {
        const auto vertex = [&](uint32_t i, uint32_t k) { return i % around * across + k % across; };
        for (uint32_t i = 0; i < around; ++i)
            for (uint32_t k = 0; k < across; ++k) {
                const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * k / across;
                const double out = 1.2 + 0.6 * std::cos(b);
                positions.emplace_back(out * std::cos(a), 0.6 * std::sin(b), out * std::sin(a));
            }
        for (uint32_t i = 0; i < around; ++i)
            for (uint32_t k = 0; k < across; ++k)
                for (const uint32_t index : {vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1), vertex(i, k),
                                             vertex(i + 1, k + 1), vertex(i + 1, k)})
                    indices.push_back(index);
    }
    MeshView view() const { return {positions, indices}; }
};

/// @param dense     with simpler occluders, clusters of every kind, and levels of detail in two parts
/// @param all_kinds  of records of clusters
inline PreparedMesh madeMesh(const Torus& torus, bool dense, bool all_kinds = true) {
    PreparedMesh mesh;
    mesh.occluder = prepareOccluder(torus.view());
    mesh.occluder_is_shape = true;
    if (!dense) return mesh;
    const auto half = static_cast<uint32_t>(torus.view().triangles() / 2);
    const MeshPart parts[] = {{0, half, false}, {half, half, true}};
    for (InnerOccluder& inner : prepareInner(torus.view())) mesh.inner.push_back(std::move(inner));
    DrawClusterSettings settings;
    settings.records.turned = settings.records.cones = all_kinds;
    settings.records.mask_steps = all_kinds ? 2 : 1;
    mesh.clusters = prepareDrawClusters(torus.view(), parts, settings);
    mesh.lods = makeLods(torus.view(), parts);
    return mesh;
}

/// Three meshes, and objects of them.
inline PreparedMeshes madeMeshes(uint64_t seed, size_t objects) {
    Random random(seed);
    PreparedMeshes out;
    out.meshes.push_back(madeMesh(Torus(24, 12), true));
    out.meshes.push_back(madeMesh(Torus(8, 5), false));
    PreparedMesh& glass = out.meshes.emplace_back();  // hides nothing, and has a shape
    glass.has_shape = true;
    glass.shape = prepareOccluder(Torus(6, 4).view());
    for (size_t i = 0; i < objects; ++i) {
        const auto mesh = static_cast<uint32_t>(random.below(4));
        out.mesh_of_object.push_back(mesh < 3 ? mesh : PreparedMeshes::kNone);
    }
    return out;
}

}  // namespace sightline::test
