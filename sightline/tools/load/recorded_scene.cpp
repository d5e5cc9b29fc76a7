// The scene of a recorded frame, for those who read scenes: witnesses, pictures, all verbs of the tool.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/recorded_scene.h"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

namespace sightline::tools {
namespace {

/// Materials of a recorded scene.
enum Look : uint32_t { kHides, kHidesBothSides, kSeen, kSeenBothSides };

Material materialOf(Look look) {
    Material material;
    material.name = look == kHides || look == kHidesBothSides ? "hides" : "may be seen";
    material.alpha_mode = look == kHides || look == kHidesBothSides ? AlphaMode::kOpaque : AlphaMode::kBlend;
    material.double_sided = look == kHidesBothSides || look == kSeenBothSides;
    if (!material.hides()) material.base_color = {0.5f, 0.6f, 0.8f, 0.5f};
    return material;
}

void addTriangles(Mesh& mesh, std::span<const uint32_t> indices, Look look) {
    if (indices.empty()) return;
    mesh.primitives.push_back(
        {static_cast<uint32_t>(mesh.triangles()), static_cast<uint32_t>(indices.size() / 3), look});
    mesh.indices.insert(mesh.indices.end(), indices.begin(), indices.end());
}

/// Of the clusters their own polygons: those of rings are others' own.
void addOccluder(Mesh& mesh, const Occluder& from, bool hides) {
    std::vector<uint32_t> indices[2];  // by the number of their sides
    for (const OccluderCluster& cluster : from.clusters) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (uint32_t v = cluster.first_vertex; v < cluster.first_vertex + cluster.vertex_count; ++v)
            mesh.positions.emplace_back(from.x[v], from.y[v], from.z[v]);
        for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
            const OccluderPolygon& polygon = from.polygons[p];
            for (int k = 2; k < polygon.corners(); ++k)
                for (const int corner : {0, k - 1, k})
                    indices[polygon.double_sided].push_back(first + polygon.vertex[corner]);
        }
    }
    addTriangles(mesh, indices[0], hides ? kHides : kSeen);
    addTriangles(mesh, indices[1], hides ? kHidesBothSides : kSeenBothSides);
}

/// The largest box of floats within a box.
Box3f within(const Box3d& box) {
    Box3f out;
    for (int axis = 0; axis < 3; ++axis) {
        float low = static_cast<float>(box.min[axis]), high = static_cast<float>(box.max[axis]);
        if (double{low} < box.min[axis]) low = std::nextafter(low, HUGE_VALF);
        if (double{high} > box.max[axis]) high = std::nextafter(high, -HUGE_VALF);
        if (low > high) low = high = static_cast<float>(box.min[axis]);  // flat, and no float lies in it
        out.min[axis] = low;
        out.max[axis] = high;
    }
    return out;
}

void addBox(Mesh& mesh, const Box3d& bounds) {
    if (bounds.empty() || !bounds.finite()) return;
    const Box3f box = within(bounds);
    if (!box.finite()) return;  // beyond all floats
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t i = 0; i < 8; ++i) mesh.positions.push_back(box.corner(i));
    std::vector<uint32_t> indices;
    for (const std::array<uint32_t, 4> face :
         {std::array<uint32_t, 4>{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        for (const int corner : {0, 1, 2, 0, 2, 3}) indices.push_back(first + face[static_cast<size_t>(corner)]);
    addTriangles(mesh, indices, kSeenBothSides);
}

Mesh meshOf(const FrameRecording& recording, const ObjectDef& object) {
    Mesh mesh;
    const auto form = [&](OccluderId id) -> const Occluder& { return recording.forms[id.index - 1].occluder; };
    if (object.occluder.index > 0) addOccluder(mesh, form(object.occluder), true);
    if (object.shape.index == 0) addBox(mesh, object.bounds);
    else if (object.shape != object.occluder) addOccluder(mesh, form(object.shape), false);
    for (const glm::vec3& position : mesh.positions) mesh.bounds.grow(glm::dvec3(position));
    return mesh;
}

SceneCamera cameraOf(const View& view) {
    SceneCamera camera;
    camera.name = "recorded";
    camera.transform = glm::inverse(view.view);
    const glm::dmat4& p = view.projection;
    double far = 0;
    if (isOrthographic(view)) {
        camera.orthographic_height = 2 / p[1][1];
        camera.z_near = (p[3][2] + 1) / p[2][2];
        far = (p[3][2] - 1) / p[2][2];
    } else {
        const double w = -p[2][3];
        camera.fov_y = 2 * std::atan(w / p[1][1]);
        camera.z_near = p[3][2] / (p[2][2] - w);
        far = p[3][2] / (p[2][2] + w);
    }
    if (std::isfinite(far) && far > camera.z_near) camera.z_far = far;
    return camera;
}

}  // namespace

Scene recordedScene(const FrameRecording& recording) {
    Scene scene;
    for (const Look look : {kHides, kHidesBothSides, kSeen, kSeenBothSides})
        scene.materials.push_back(materialOf(look));
    using Parts = std::tuple<uint32_t, uint32_t, std::array<double, 6>>;
    std::map<Parts, uint32_t> meshes;
    for (const ObjectDef& object : recording.objects) {
        Parts parts{object.occluder.index, object.shape.index, {}};
        if (object.shape.index == 0 && object.bounds.finite())
            for (int axis = 0; axis < 3; ++axis) {
                std::get<2>(parts)[static_cast<size_t>(axis)] = object.bounds.min[axis];
                std::get<2>(parts)[static_cast<size_t>(3 + axis)] = object.bounds.max[axis];
            }
        const auto [at, fresh] = meshes.try_emplace(parts, static_cast<uint32_t>(scene.meshes.size()));
        if (fresh) scene.meshes.push_back(meshOf(recording, object));
        SceneObject& to = scene.objects.emplace_back();
        to.key = object.key;
        to.mesh = at->second;
        to.transform = object.transform;
        to.name = "key " + std::to_string(object.key);
    }
    scene.cameras.push_back(cameraOf(recording.view));
    return scene;
}

}  // namespace sightline::tools
