// The triangles of a box, and the transform that makes a unit cube into it: for devices that draw boxes.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

inline constexpr glm::vec3 kCubeCorners[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                              {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
/// Counter-clockwise from outside.
inline constexpr uint32_t kCubeTriangles[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

inline glm::dmat4 cubeToBox(const Box3d& box) {
    glm::dmat4 transform(1.0);
    const glm::dvec3 size = box.size();
    for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = size[axis];
    transform[3] = glm::dvec4(box.min, 1.0);
    return transform;
}

}  // namespace sightline
