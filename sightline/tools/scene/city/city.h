// A procedural city: streets, buildings with recesses, street furniture.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Builds a city of exactly `objects` objects, deterministic in (seed, objects). A larger city keeps the
/// smaller one of the same seed, object by object and key by key, and surrounds it. Metres, y up, the ground at
/// y = 0. Meshes are shared by instances, so that 10^6 objects fit in memory.
/// @param objects  [limit: 1 to 10,000,000]
Scene makeCity(uint64_t seed, uint32_t objects);

/// A walk along the streets of the city's centre at eye height: the same cameras for every size of the
/// city, so that growth can be measured.
/// @param frames  [limit: >= 1]
CameraPath cityStreetPath(uint64_t seed, uint32_t frames);

}  // namespace sightline::tools
