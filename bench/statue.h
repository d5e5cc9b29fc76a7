// A dense closed surface, for cases that need triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::bench {

/// An octahedron, each face divided, blown up to a bumpy sphere of radius 1, about.
/// @param divisions  of an edge of the octahedron: 8 divisions^2 triangles
tools::Mesh makeStatue(uint32_t divisions);

}  // namespace sightline::bench
