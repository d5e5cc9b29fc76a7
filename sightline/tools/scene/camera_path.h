// Camera paths: a list of frames, its JSON form, and the views that they stand for.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// One frame of a path. With matrices, they replace everything else.
struct CameraFrame {
    glm::dvec3 eye{0, 0, 0};
    glm::dvec3 target{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    double fov_y_degrees = 60;
    double z_near = 0.1;
    std::optional<double> z_far;                 ///< none: infinite
    std::optional<double> orthographic_height;   ///< full height [world units]; replaces the angle
    std::optional<glm::dmat4> view, projection;  ///< both or neither
};

struct CameraPath {
    std::vector<CameraFrame> frames;
};

/// The view of a frame for a viewport of the given size.
View makeView(const CameraFrame& frame, uint32_t width, uint32_t height);

/// Reads the JSON of docs/command-line/cameras.md, "Camera path files": values of the head that each frame may override.
/// Errors name the file and the frame: not JSON, no frames, wrong types, values that are not finite,
/// near <= 0 (perspective), far <= near, an angle outside (0, 180), eye equal to target, keys that there are not, views
/// that are not rigid. Matrices of other clip spaces are declared ("clip", a name of kClipSpaces), or told where they
/// tell (tellClipSpace()); a frame's are those of a View.
Result<CameraPath> readCameraPath(const std::string& file);
/// The same of a text.
/// @param file  named by errors
Result<CameraPath> parseCameraPath(std::string_view text, const std::string& file);

/// The same text back; reading it gives the same path bit by bit.
std::string cameraPathJson(const CameraPath& path);

/// The scene's own cameras as a path, one frame each.
CameraPath sceneCameras(const Scene& scene);

}  // namespace sightline::tools
