// Triangles anywhere: through one another, turned round, one-sided or not, large and small.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <utility>

#include "sightline/base/random.h"
#include "tests/bake/marked/made_rooms.h"

namespace sightline::test {

inline MarkedRooms anyTriangles(Random& random) {
    MarkedRooms made;
    made.scene.materials.emplace_back().double_sided = true;
    const auto count = 4 + random.below(40);
    for (uint64_t i = 0; i < count; ++i) {
        Mesh mesh;
        const double size = std::pow(10, random.uniform(-1, 1));
        glm::dvec3 middle;
        for (int axis = 0; axis < 3; ++axis) middle[axis] = random.uniform(-4, 4);
        for (int corner = 0; corner < 3; ++corner) {
            glm::dvec3 point = middle;
            for (int axis = 0; axis < 3; ++axis) point[axis] += random.uniform(-size, size);
            if (i % 3 == 0) point[int(i) % 3] = std::round(middle[int(i) % 3]);  // many share a plane
            mesh.positions.emplace_back(point);
        }
        mesh.indices = {0, 1, 2};
        made.add(std::move(mesh), uint32_t(random.below(2)));
    }
    return made;
}

}  // namespace sightline::test
