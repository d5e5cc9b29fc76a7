// A camera in the JSON of results: reading it back as a frame of a camera path gives the same view.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/camera_json.h"

#include <cmath>

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

Json matrixJson(const glm::dmat4& m) {
    Json out = Json::array();
    for (int i = 0; i < 16; ++i) out.push_back(m[i / 4][i % 4]);
    return out;
}

}  // namespace

nlohmann::ordered_json cameraJson(CameraFrame camera) {
    if (camera.view && camera.projection) {  // the matrices count; the rest describes them
        View view;
        view.view = *camera.view;
        view.projection = *camera.projection;
        camera.eye = eyePosition(view);
        const glm::dmat3 axes = glm::transpose(glm::dmat3(*camera.view));
        camera.target = camera.eye - axes[2];
        camera.up = axes[1];
        if (!isOrthographic(view))
            camera.fov_y_degrees = 2 * std::atan(1 / view.projection[1][1]) * 180 / 3.14159265358979323846;
    }
    Json out;
    out["eye"] = vectorJson(camera.eye);
    out["target"] = vectorJson(camera.target);
    out["up"] = vectorJson(camera.up);
    out["fov_y_degrees"] = camera.fov_y_degrees;
    out["near"] = camera.z_near;
    out["far"] = camera.z_far ? Json(*camera.z_far) : Json(nullptr);
    if (camera.orthographic_height) out["orthographic_height"] = *camera.orthographic_height;
    if (camera.view && camera.projection) {
        out["view"] = matrixJson(*camera.view);
        out["projection"] = matrixJson(*camera.projection);
    }
    return out;
}

}  // namespace sightline::tools
