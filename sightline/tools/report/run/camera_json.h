// A camera in the JSON of results: reading it back as a frame of a camera path gives the same view.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "sightline/tools/scene/camera_path.h"

namespace sightline::tools {

nlohmann::ordered_json cameraJson(CameraFrame camera);

}  // namespace sightline::tools
