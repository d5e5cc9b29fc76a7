// Curved patches of Quake 3 as triangles.
// SPDX-License-Identifier: MIT
//
// Pierre Bezier. Procede de definition numerique des courbes et surfaces non mathematiques. 1968.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Fills a mesh's positions, indices and bounds with biquadratic patches, each as 4 x 4 squares. The bounds hold all
/// control points, and so any finer cut: a Bezier surface lies in the hull of its control points. The mesh deforms:
/// it hides nothing.
/// @param control  row by row  [size: width * height, both odd and at least 3]
void tessellatePatch(std::span<const glm::vec3> control, uint32_t width, uint32_t height, Mesh& mesh);

}  // namespace sightline::tools
