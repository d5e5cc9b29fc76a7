// Reads cameras and places them where drawn nodes hold them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_cameras.h"

#include <cmath>

namespace sightline::tools::gltf {
namespace {

constexpr double kPi = 3.14159265358979323846;

void readFar(const Json& lens, CameraSource& camera, const std::string& place) {
    const std::optional<double> z_far = number(lens, "zfar", place);
    if (z_far && !(*z_far > camera.z_near)) fail(place, "zfar {} is not beyond znear {}", *z_far, camera.z_near);
    camera.z_far = z_far;
}

void readPerspective(const Json& lens, CameraSource& camera, const std::string& place) {
    camera.fov_y = number(lens, "yfov", place).value_or(0);
    if (!(camera.fov_y > 0 && camera.fov_y < kPi)) fail(place, "yfov {} is not between 0 and pi", camera.fov_y);
    camera.z_near = number(lens, "znear", place).value_or(0);
    if (!(camera.z_near > 0)) fail(place, "znear {} is not above 0", camera.z_near);
    readFar(lens, camera, place);
}

void readOrthographic(const Json& lens, CameraSource& camera, const std::string& place) {
    camera.orthographic_height = 2 * std::abs(number(lens, "ymag", place).value_or(0));
    if (!(camera.orthographic_height > 0 && std::isfinite(camera.orthographic_height)))
        fail(place, "ymag is not above 0");
    camera.z_near = number(lens, "znear", place).value_or(0);
    readFar(lens, camera, place);
}

CameraSource readCamera(const Json& json, const std::string& place) {
    CameraSource camera;
    camera.name = text(json, "name", place);
    const std::string type = text(json, "type", place);
    if (type != "perspective" && type != "orthographic") fail(place, "type '{}' is not known", printable(type));
    const Json* lens = findObject(json, type.c_str(), place);
    if (!lens) fail(place, "{} is missing", type);
    if (type == "perspective") readPerspective(*lens, camera, place + ".perspective");
    else readOrthographic(*lens, camera, place + ".orthographic");
    return camera;
}

// A scale of zero, as some files hide a node with, leaves a camera without a direction.
bool looksSomewhere(const glm::dmat4& world) {
    const double up = glm::length(glm::dvec3(world[1])), back = glm::length(glm::dvec3(world[2]));
    if (!(up > 0 && back > 0 && std::isfinite(up) && std::isfinite(back))) return false;
    return glm::length(glm::cross(glm::dvec3(world[1]) / up, glm::dvec3(world[2]) / back)) > 1e-9;
}

}  // namespace

std::vector<CameraSource> readCameras(const JsonText& json) {
    const JsonTable array = json.table("cameras");
    std::vector<CameraSource> out;
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("cameras", i);
        out.push_back(readCamera(array.object(i, place), place));
    }
    return out;
}

std::vector<SceneCamera> placeCameras(const NodeTree& tree, const std::vector<CameraSource>& cameras) {
    std::vector<SceneCamera> out;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        const Node& node = tree.nodes[i];
        if (!node.drawn || !node.camera) continue;
        if (!finiteMatrix(node.world)) fail(at("nodes", i), "its world transform is not finite");
        if (!looksSomewhere(node.world)) continue;
        out.push_back(cameras[*node.camera]);
        out.back().transform = node.world;
        if (!tree.names[i].name.empty()) out.back().name = tree.names[i].name;
    }
    return out;
}

}  // namespace sightline::tools::gltf
