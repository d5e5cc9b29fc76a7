// The vertices of quantised occluders in 16 bits a coordinate, for files and for the wire.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sightline/geom/occluder.h"

namespace sightline {

/// Half the size of Occluder's x, y, z; the same numbers.
struct PackedVertices {
    glm::vec3 origin{0.0f};
    float step = 0;  ///< a power of two
    std::vector<uint16_t> x, y, z;
};

/// Nothing if a vertex does not lie on the grid: only those of InnerSettings::quantise do.
std::optional<PackedVertices> packVertices(const InnerOccluder& inner);

/// Sets an occluder's vertices, bit for bit as they were packed.
void unpackVertices(const PackedVertices& packed, Occluder& occluder);

}  // namespace sightline
