// What Assimp leaves to others: units and axes that a file declares, and cameras.
// SPDX-License-Identifier: MIT
#include "apps/import/placement.h"

#include <algorithm>
#include <cmath>

#include <assimp/metadata.h>

#include "sightline/math/stretch.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"

namespace sightline::import {
using namespace tools;
namespace {

int whole(const aiMetadata& data, const char* key, int otherwise) {
    int32_t value = 0;
    return data.Get(key, value) ? value : otherwise;
}

double number(const aiMetadata& data, const char* key, double otherwise) {
    double exact = 0;
    float rough = 0;
    if (data.Get(key, exact)) return exact;
    return data.Get(key, rough) ? rough : otherwise;
}

/// Autodesk. FBX SDK, FbxGlobalSettings and FbxAxisSystem.
glm::dmat4 fbxPlacement(const aiMetadata& data) {
    const int axes[3] = {whole(data, "CoordAxis", 0), whole(data, "UpAxis", 1), whole(data, "FrontAxis", 2)};
    const int signs[3] = {whole(data, "CoordAxisSign", 1), whole(data, "UpAxisSign", 1),
                          whole(data, "FrontAxisSign", 1)};
    glm::dmat3 turn(0.0);
    for (int row = 0; row < 3; ++row)
        if (axes[row] >= 0 && axes[row] <= 2) turn[axes[row]][row] = signs[row] < 0 ? -1 : 1;
    if (std::abs(glm::determinant(turn)) != 1) turn = glm::dmat3(1.0);  // the same axis twice
    const double unit = number(data, "UnitScaleFactor", 1) * 0.01;      // it counts centimetres
    return glm::dmat4(std::isfinite(unit) && unit > 0 ? unit * turn : turn);
}

}  // namespace

glm::dmat4 placementOf(const aiScene& scene, const std::string& suffix) {
    return suffix == "fbx" && scene.mMetaData ? fbxPlacement(*scene.mMetaData) : glm::dmat4(1.0);
}

std::optional<SceneCamera> cameraOf(const aiCamera& camera, const glm::dmat4& node) {
    const auto vector = [](const aiVector3D& v) { return glm::dvec3(v.x, v.y, v.z); };
    const glm::dmat3 turn(node);
    const glm::dvec3 ahead = turn * vector(camera.mLookAt);
    glm::dvec3 up = turn * vector(camera.mUp);
    const glm::dvec3 side = glm::cross(ahead, up);
    if (!(glm::length(side) > 1e-9 * glm::length(ahead) * glm::length(up))) return std::nullopt;
    const glm::dvec3 x = glm::normalize(side), z = -glm::normalize(ahead);
    SceneCamera out;
    out.name = camera.mName.C_Str();
    out.transform = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                               node * glm::dvec4(vector(camera.mPosition), 1));
    const double scale = largestStretch(node);
    const double aspect = camera.mAspect > 0 && std::isfinite(camera.mAspect) ? camera.mAspect : 16.0 / 9;
    if (camera.mOrthographicWidth > 0) out.orthographic_height = 2 * scale * camera.mOrthographicWidth / aspect;
    else out.fov_y = 2 * std::atan(std::tan(0.5 * camera.mHorizontalFOV) / aspect);
    if (!(out.fov_y > 0 && out.fov_y < 3.14) && !(out.orthographic_height > 0)) return std::nullopt;
    const double nearest = scale * camera.mClipPlaneNear, farthest = scale * camera.mClipPlaneFar;
    if (nearest > 0 && std::isfinite(nearest)) out.z_near = nearest;
    if (farthest > out.z_near && std::isfinite(farthest)) out.z_far = farthest;
    if (!gltf::finiteMatrix(out.transform) || !std::isfinite(out.orthographic_height)) return std::nullopt;
    return out;
}

}  // namespace sightline::import
