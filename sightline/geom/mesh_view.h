// Triangles that belong to somebody else, read in place.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/math/glm_types.h"

namespace sightline {

/// An indexed triangle list. Counter-clockwise is front.
struct MeshView {
    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;  ///< [size: 3 * triangles; each < positions.size()]
    size_t triangles() const { return indices.size() / 3; }
};

}  // namespace sightline
