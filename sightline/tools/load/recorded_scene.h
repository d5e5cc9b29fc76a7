// The scene of a recorded frame, for those who read scenes: witnesses, pictures, all verbs of the tool.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/query/record/frame_recording.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Object by object what a recording knows of it. What an object hides with hides. What else may be drawn of it is seen
/// and hides nothing: the triangles of its shape or, where it has none, the box that it lies in. The recorded view is the
/// scene's camera, but for a shift of its image.
Scene recordedScene(const FrameRecording& recording);

}  // namespace sightline::tools
