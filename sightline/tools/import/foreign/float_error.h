// What is lost of a scene's coordinates where a reader holds them as 32-bit numbers.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// One line if rounding to floats may have moved a point by more than 1 mm: by how much, and what to do. Else empty. A float is
/// off by 2^-24 at most. Vertices count in the world's scale, and places of objects.
/// @param scale  metres of a unit of the scene
std::string floatErrorText(const Scene& scene, double scale);

}  // namespace sightline::tools
