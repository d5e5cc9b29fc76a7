// Turns and scales scenes, and makes one of several.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/marked_cells.h"

namespace sightline::tools {
namespace {

/// The turn that makes an axis y.
glm::dmat3 turnTo(UpAxis up) {
    switch (up) {
        case UpAxis::kX:  // (x, y, z) -> (-y, x, z)
            return {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
        case UpAxis::kZ:  // (x, y, z) -> (x, z, -y)
            return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
        case UpAxis::kAsFileSays:
        case UpAxis::kY:
            break;
    }
    return glm::dmat3(1.0);
}

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// The file's name without folders and suffix; a procedural scene's whole name.
std::string stemOf(const Scene& scene) {
    return scene.files.empty() ? scene.name : std::filesystem::path(scene.name).stem().string();
}

/// Where a scene's things begin in the joined one.
struct Offsets {
    uint32_t materials, meshes, objects, nodes, cells;
    uint64_t key;
};

void shift(Scene& scene, const Offsets& by, uint32_t root) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& part : mesh.primitives) part.material += by.materials;
    for (SceneNode& node : scene.nodes) node.parent = node.parent == SceneNode::kNone ? root : node.parent + by.nodes;
    for (SceneObject& object : scene.objects) {
        object.key += by.key;
        object.mesh += by.meshes;
        object.node = object.node == SceneNode::kNone ? root : object.node + by.nodes;
    }
    for (SceneLevel& level : scene.levels) {
        level.object += by.objects;
        level.mesh += by.meshes;
    }
    for (ScenePortal& portal : scene.portals) {
        for (uint32_t& cell : portal.cells)
            if (cell != ScenePortal::kNone) cell += by.cells;
        if (portal.door != ScenePortal::kNone) portal.door += by.objects;
    }
    for (SceneRoom& room : scene.rooms) room.node = room.node == SceneNode::kNone ? root : room.node + by.nodes;
    for (SceneFile& file : scene.files) file.first_key += by.key;
}

}  // namespace

void placeScene(Scene& scene, const ImportSettings& settings) {
    if (settings.sides != Sides::kAsFileSays)
        for (Material& material : scene.materials) material.double_sided = settings.sides == Sides::kBoth;
    const glm::dmat3 turn = turnTo(settings.up);
    const double scale = settings.scale;
    if (turn == glm::dmat3(1.0) && scale == 1) return;
    const glm::dmat4 place(scale * turn);
    for (SceneObject& object : scene.objects) object.transform = place * object.transform;
    for (SceneCamera& camera : scene.cameras) {
        const glm::dvec3 eye = scale * (turn * glm::dvec3(camera.transform[3]));
        camera.transform = glm::dmat4(turn) * camera.transform;
        camera.transform[3] = glm::dvec4(eye, 1.0);
        camera.orthographic_height *= scale;
        camera.z_near *= scale;
        if (camera.z_far) *camera.z_far *= scale;
    }
    for (SceneRoom& room : scene.rooms) room.bounds = transformBox(room.bounds, place);
    scene.walk_speed *= scale;
    for (SceneCell& cell : scene.cells) {
        for (glm::dvec4& plane : cell.planes) plane = glm::dvec4(turn * glm::dvec3(plane), scale * plane.w);
        cell.bounds = transformBox(cell.bounds, place);
        cell.overhang *= scale;
    }
    for (ScenePortal& portal : scene.portals) {
        for (glm::dvec3& corner : portal.polygon) corner = scale * (turn * corner);
        portal.slide = scale * (turn * portal.slide);
    }
}

Scene joinScenes(std::vector<Scene> scenes) {
    if (scenes.size() == 1) return std::move(scenes.front());
    Scene out;
    uint64_t next_key = 0;
    std::vector<std::string> names;
    for (Scene& scene : scenes) {
        const auto root = static_cast<uint32_t>(out.nodes.size());
        out.nodes.push_back({stemOf(scene), SceneNode::kNone});
        if (scene.files.empty()) scene.files.push_back({scene.name, 0});
        const Offsets by{static_cast<uint32_t>(out.materials.size()), static_cast<uint32_t>(out.meshes.size()),
                         static_cast<uint32_t>(out.objects.size()),   static_cast<uint32_t>(out.nodes.size()),
                         static_cast<uint32_t>(out.cells.size()),     next_key};
        shift(scene, by, root);
        for (const SceneObject& object : scene.objects) next_key = std::max(next_key, object.key + 1);
        names.push_back(scene.name);
        append(out.materials, std::move(scene.materials));
        append(out.meshes, std::move(scene.meshes));
        append(out.objects, std::move(scene.objects));
        append(out.levels, std::move(scene.levels));
        out.walk_speed = std::max(out.walk_speed, scene.walk_speed);
        append(out.cameras, std::move(scene.cameras));
        append(out.nodes, std::move(scene.nodes));
        append(out.cells, std::move(scene.cells));
        append(out.portals, std::move(scene.portals));
        append(out.rooms, std::move(scene.rooms));
        append(out.files, std::move(scene.files));
    }
    out.name = joinedFew(names);
    resolvePortals(out);  // cells of one file and portals of another may belong together
    return out;
}

}  // namespace sightline::tools
