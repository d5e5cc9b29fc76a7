// The planes of a mesh's triangles, as the test for back faces reads them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

#include "sightline/base/array.h"

namespace sightline {

/// One plane per triangle, as one array per number: seen from e, counter-clockwise iff n * (e - origin) + d > 0.
/// studies/facing/triangle_planes.h makes it.
struct TrianglePlanes {
    static constexpr size_t kPadding = 64;

    /// Unit normals and distances from the origin. All 0 where rounding hides which way a triangle faces.
    Array<float> x, y, z, d;  ///< [size: count rounded up to kPadding]
    size_t count = 0;
    glm::dvec3 origin{0.0};
    double reach = 0;  ///< no corner is farther from the origin, by the sum of the three axes

    explicit TrianglePlanes(Memory* memory = defaultMemory()) : x(memory), y(memory), z(memory), d(memory) {}
};

}  // namespace sightline
