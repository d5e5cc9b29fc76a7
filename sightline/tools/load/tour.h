// The path of who asks for none: the whole of a scene first, then the way that suits it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// One view of the whole from outside; then, where there is a floor, a walk over it (walkOver()), whose frames are so far
/// apart that few of them see most of it; else, around a thing, an orbit. Deterministic in (scene, frames, seed).
CameraPath tourOf(const Scene& scene, uint32_t frames, uint64_t seed);

}  // namespace sightline::tools
