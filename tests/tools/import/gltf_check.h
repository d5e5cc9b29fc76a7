// What must hold for every scene that the glTF reader hands out, whatever it was made from.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::test {
using namespace tools;

inline std::string meshFault(const Scene& scene, const Mesh& mesh) {
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) return "indices are no triangles";
    for (const uint32_t index : mesh.indices)
        if (index >= mesh.positions.size()) return "an index is out of range";
    if (!mesh.bounds.finite()) return "bounds are not finite";
    for (const glm::vec3& position : mesh.positions)
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(position[axis])) return "a position is not finite";
            if (position[axis] < mesh.bounds.min[axis] || position[axis] > mesh.bounds.max[axis])
                return "a position is out of bounds";
        }
    uint64_t triangles = 0;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.first_triangle != triangles) return "primitives leave a gap";
        if (primitive.material >= scene.materials.size()) return "a material is out of range";
        triangles += primitive.triangle_count;
    }
    return triangles == mesh.triangles() ? "" : "primitives do not cover the triangles";
}

inline std::string cellFault(const Scene& scene) {
    for (const SceneCell& cell : scene.cells) {
        if (!(cell.overhang >= 0)) return "an overhang is negative or NaN";
        if (cell.planes.empty() && std::isfinite(cell.overhang)) return "a solid cell has no planes";
        if (!cell.planes.empty() && !cell.bounds.finite()) return "a cell's bounds are not finite";
        for (const glm::dvec4& plane : cell.planes) {
            if (!(std::abs(glm::length(glm::dvec3(plane)) - 1) < 1e-9)) return "a cell's normal is no unit vector";
            if (!std::isfinite(plane.w)) return "a cell's plane is not finite";
        }
    }
    for (const ScenePortal& portal : scene.portals) {
        for (const uint32_t cell : portal.cells)
            if (cell != ScenePortal::kNone && cell >= scene.cells.size()) return "a portal's cell is out of range";
        if (portal.door != ScenePortal::kNone && portal.door >= scene.objects.size()) return "a door is out of range";
        for (const glm::dvec3& corner : portal.polygon)
            if (!std::isfinite(corner.x + corner.y + corner.z)) return "a portal is not finite";
        if (!std::isfinite(portal.slide.x + portal.slide.y + portal.slide.z)) return "a slide is not finite";
    }
    return "";
}

/// Empty, or what is wrong with the scene.
inline std::string sceneFault(const Scene& scene) {
    if (scene.materials.empty()) return "no material";
    if (scene.objects.empty() && scene.cells.empty() && scene.portals.empty()) return "no object";
    for (const SceneLevel& level : scene.levels) {
        if (level.object >= scene.objects.size()) return "a level's object is out of range";
        if (level.mesh >= scene.meshes.size()) return "a level's mesh is out of range";
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(glm::dot(level.transform[column], glm::dvec4(1.0)))) return "a level is not finite";
    }
    for (const Mesh& mesh : scene.meshes)
        if (const std::string fault = meshFault(scene, mesh); !fault.empty()) return fault;
    for (const SceneObject& object : scene.objects) {
        if (object.mesh >= scene.meshes.size()) return "a mesh is out of range";
        if (object.node >= scene.nodes.size()) return "a node is out of range";
        if (!transformBox(scene.meshes[object.mesh].bounds, object.transform).finite())
            return "an object is not finite";
        for (int column = 0; column < 4; ++column)
            if (object.transform[column][3] != (column == 3 ? 1 : 0)) return "a transform is not affine";
    }
    for (const SceneRoom& room : scene.rooms)
        if (room.node >= scene.nodes.size() || (!room.bounds.empty() && !room.bounds.finite()))
            return "a room is broken";
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].parent != SceneNode::kNone && scene.nodes[i].parent >= scene.nodes.size())
            return "a node's parent is out of range";
    for (const SceneCamera& camera : scene.cameras) {
        if ((camera.fov_y > 0) == (camera.orthographic_height > 0)) return "a camera is of neither kind";
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                if (!std::isfinite(camera.transform[column][row])) return "a camera is not finite";
        if (!(glm::length(glm::cross(glm::dvec3(camera.transform[1]), glm::dvec3(camera.transform[2]))) > 0))
            return "a camera looks nowhere";
    }
    if (const std::string fault = cellFault(scene); !fault.empty()) return fault;
    return scene.objects.empty() || worldBounds(scene).finite() ? "" : "the world is not finite";
}

/// Empty, or what is wrong with the message of an error: it must be one line that begins with the file's name.
inline std::string messageFault(const Error& error, const std::string& name) {
    if (error.kind != Error::Kind::kInput) return "is not an input's fault";
    if (!error.message.starts_with(name + ": ")) return "does not name the file";
    for (const char c : error.message)
        if (static_cast<unsigned char>(c) < 0x20) return "is not one line";
    return "";
}

}  // namespace sightline::test
