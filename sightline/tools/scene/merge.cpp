// Joins small objects that are near one another: where a draw call costs more than what it draws.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/merge.h"

#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

using MergeCube = std::tuple<int64_t, int64_t, int64_t>;

/// Objects of each cube that may be joined, in their order.
std::map<MergeCube, std::vector<uint32_t>> smallOf(const Scene& scene, const MergeSmall& settings) {
    std::vector<bool> stays(scene.objects.size(), false);
    for (const ScenePortal& portal : scene.portals)
        if (portal.door < stays.size()) stays[portal.door] = true;
    std::vector<glm::dvec3> centres(scene.objects.size());
    Box3d all;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.objects[i].mesh];
        if (mesh.deforms || mesh.triangles() >= settings.triangles || mesh.triangles() == 0 ||
            !isFinite(scene.objects[i].transform))
            stays[i] = true;
        if (stays[i]) continue;
        const Box3d box = transformBox(mesh.bounds, scene.objects[i].transform);
        stays[i] = !box.finite() || box.empty();
        if (stays[i]) continue;
        centres[i] = box.center();
        all.grow(centres[i]);
    }
    std::map<MergeCube, std::vector<uint32_t>> small;
    if (all.empty()) return small;
    const glm::dvec3 size = all.size();
    const double side = std::max({size.x, size.y, size.z}) / std::max(settings.cubes, 1u);
    const int64_t last = std::max(settings.cubes, 1u) - int64_t{1};  // what lies in the far faces is in the last cubes
    const auto cubeOf = [&](double at, double from) {
        return side > 0 ? std::min(last, static_cast<int64_t>(std::floor((at - from) / side))) : int64_t{0};
    };
    for (uint32_t i = 0; i < scene.objects.size(); ++i)
        if (!stays[i])
            small[{cubeOf(centres[i].x, all.min.x), cubeOf(centres[i].y, all.min.y), cubeOf(centres[i].z, all.min.z)}]
                .push_back(i);
    return small;
}

/// One mesh of several objects, in coordinates relative to a place.
class JoinedMesh {
public:
    JoinedMesh(const Scene& scene, const glm::dvec3& anchor) : scene_(scene), anchor_(anchor) {}

    void add(const SceneObject& object) {
        const Mesh& from = scene_.meshes[object.mesh];
        const auto base = static_cast<uint32_t>(mesh_.positions.size());
        for (const glm::vec3& position : from.positions) {
            const glm::dvec3 world(object.transform * glm::dvec4(glm::dvec3(position), 1.0));
            mesh_.positions.emplace_back(world - anchor_);
            mesh_.bounds.grow(glm::dvec3(mesh_.positions.back()));
        }
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        for (const Primitive& primitive : from.primitives)
            for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
                std::vector<uint32_t>& to = by_material_[primitive.material];
                const uint32_t* const corners = &from.indices[3 * size_t{t}];
                to.insert(to.end(),
                          {base + corners[0], base + corners[mirrored ? 2 : 1], base + corners[mirrored ? 1 : 2]});
            }
    }

    Mesh take(std::string name) {
        mesh_.name = std::move(name);
        for (const auto& [material, indices] : by_material_) {
            mesh_.primitives.push_back(
                {static_cast<uint32_t>(mesh_.triangles()), static_cast<uint32_t>(indices.size() / 3), material});
            mesh_.indices.insert(mesh_.indices.end(), indices.begin(), indices.end());
        }
        return std::move(mesh_);
    }

private:
    const Scene& scene_;
    glm::dvec3 anchor_;
    Mesh mesh_;
    std::map<uint32_t, std::vector<uint32_t>> by_material_;
};

/// Leaves out the meshes of objects that are joined.
void dropUnusedMeshes(Scene& scene) {
    std::vector<uint32_t> now(scene.meshes.size(), 0);
    for (const SceneObject& object : scene.objects) now[object.mesh] = 1;
    uint32_t next = 0;
    for (size_t i = 0; i < now.size(); ++i) {
        if (now[i] == 0) continue;
        if (next != i) scene.meshes[next] = std::move(scene.meshes[i]);
        now[i] = next++;
    }
    scene.meshes.resize(next);
    for (SceneObject& object : scene.objects) object.mesh = now[object.mesh];
}

}  // namespace

MergedScene mergeSmall(Scene scene, const MergeSmall& settings) {
    MergedScene out;
    std::vector<bool> gone(scene.objects.size(), false);
    std::vector<Mesh> meshes;
    std::vector<SceneObject> objects;
    uint64_t key = 0;
    for (const SceneObject& object : scene.objects) key = std::max(key, object.key);
    for (const auto& [cube, members] : smallOf(scene, settings)) {
        if (members.size() < 2) continue;
        Box3d box;
        for (const uint32_t i : members) {
            const SceneObject& object = scene.objects[i];
            box.grow(transformBox(scene.meshes[object.mesh].bounds, object.transform).center());
        }
        const glm::dvec3 anchor = box.center();
        JoinedMesh mesh(scene, anchor);
        for (const uint32_t i : members) {
            mesh.add(scene.objects[i]);
            gone[i] = true;
        }
        SceneObject object;
        object.key = ++key;
        object.mesh = static_cast<uint32_t>(scene.meshes.size() + meshes.size());
        object.transform[3] = glm::dvec4(anchor, 1.0);
        object.name = fmt::format("{} small objects", members.size());
        meshes.push_back(mesh.take(object.name));
        objects.push_back(std::move(object));
        out.small += members.size();
        ++out.joined;
    }
    std::vector<uint32_t> now(scene.objects.size(), ScenePortal::kNone);
    std::vector<SceneObject> left;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        if (gone[i]) continue;
        now[i] = static_cast<uint32_t>(left.size());
        left.push_back(std::move(scene.objects[i]));
    }
    for (SceneObject& object : objects) left.push_back(std::move(object));
    for (ScenePortal& portal : scene.portals)
        if (portal.door < now.size()) portal.door = now[portal.door];
    scene.objects = std::move(left);
    for (Mesh& mesh : meshes) scene.meshes.push_back(std::move(mesh));
    dropUnusedMeshes(scene);
    out.scene = std::move(scene);
    return out;
}

}  // namespace sightline::tools
