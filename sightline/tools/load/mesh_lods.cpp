// Levels of detail of a scene's meshes: made where there are none, and measured where the scene brought its own.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/mesh_lods.h"

#include <algorithm>

namespace sightline::tools {
namespace {

uint32_t verticesOf(const std::vector<uint32_t>& indices) {
    std::vector<uint32_t> named = indices;
    std::sort(named.begin(), named.end());
    return static_cast<uint32_t>(std::unique(named.begin(), named.end()) - named.begin());
}

/// Measures levels that came with the scene, and leaves out those that are of no use.
void measure(Mesh& mesh, const LodChainSettings& settings) {
    const DistanceSurface whole({mesh.positions, mesh.indices});
    size_t triangles = mesh.triangles();
    double error = 0;
    std::vector<MeshLod> useful;
    for (MeshLod& lod : mesh.lods) {
        if (lod.error == MeshLod::kUnknown) {
            const DistanceSurface coarse({mesh.positions, lod.indices});
            lod.error = surfaceDistance(whole, coarse, settings.distance).upper;
        }
        if (!(lod.error >= error) || lod.indices.size() / 3 >= triangles || useful.size() + 1 >= kMostLods) continue;
        error = lod.error;
        triangles = lod.indices.size() / 3;
        lod.vertices = verticesOf(lod.indices);
        useful.push_back(std::move(lod));
    }
    mesh.lods = std::move(useful);
}

/// The triangles of a primitive that stand in a level, appended to it.
void append(const LodChain& chain, uint32_t level, uint32_t part, uint32_t material, MeshLod& lod) {
    const std::span<const uint32_t> indices = chain.indicesOf(level, part);
    if (indices.empty()) return;
    lod.primitives.push_back(
        {static_cast<uint32_t>(lod.indices.size() / 3), static_cast<uint32_t>(indices.size() / 3), material});
    lod.indices.insert(lod.indices.end(), indices.begin(), indices.end());
}

}  // namespace

void addMeshLods(Mesh& mesh, const LodChainSettings& settings) {
    if (mesh.deforms) return mesh.lods.clear();
    if (!mesh.lods.empty()) return measure(mesh, settings);
    setMeshLods(mesh, lodChainOf(mesh, settings));
}

LodChain lodChainOf(const Mesh& mesh, const LodChainSettings& settings) {
    if (mesh.deforms || !mesh.lods.empty() || mesh.triangles() < kLeastForLods) return LodChain();
    std::vector<MeshPart> parts;
    for (const Primitive& primitive : mesh.primitives)
        parts.push_back({primitive.first_triangle, primitive.triangle_count, false});
    return makeLods({mesh.positions, mesh.indices}, parts, settings);
}

bool setMeshLods(Mesh& mesh, const LodChain& chain) {
    const size_t parts = std::max<size_t>(1, mesh.primitives.size());
    if (chain.levels.size() > 1 && chain.parts != parts) return false;
    for (const uint32_t index : chain.indices)
        if (index >= mesh.positions.size()) return false;
    mesh.lods.clear();
    for (uint32_t level = 1; level < chain.levels.size(); ++level) {
        MeshLod& lod = mesh.lods.emplace_back();
        lod.error = chain.levels[level].error;
        lod.vertices = chain.levels[level].vertices;
        for (uint32_t part = 0; part < chain.parts; ++part)
            append(chain, level, part, mesh.primitives.empty() ? 0 : mesh.primitives[part].material, lod);
    }
    return true;
}

std::vector<LodLevel> lodLevels(const Mesh& mesh) {
    std::vector<LodLevel> levels;
    levels.push_back({0, static_cast<uint32_t>(mesh.triangles()), verticesOf(mesh.indices)});
    for (const MeshLod& lod : mesh.lods)
        levels.push_back({lod.error, static_cast<uint32_t>(lod.indices.size() / 3), lod.vertices});
    return levels;
}

}  // namespace sightline::tools
