// A hall whose dividing wall has a slit at any place and angle.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "sightline/base/random.h"
#include "tests/bake/marked/made_rooms.h"

namespace sightline::test {

/// Two halls, 50 units long, and a wall with a slit between them.
inline MarkedRooms slitRoom(Random& random, double width, double turn) {
    MarkedRooms made;
    made.room({{0, 0, 0}, {25, 3, 20}}, 2);
    made.room({{25, 0, 0}, {50, 3, 20}}, 1);
    // Four triangles around a thin, turned rectangle: two halves of the wall, apart by the slit.
    const glm::dvec2 middle(random.uniform(0.5, 2.5), random.uniform(2, 18));
    const glm::dvec2 along(std::sin(turn), std::cos(turn)), across(along.y, -along.x);
    for (const double side : {-1.0, 1.0})
        for (const bool front : {false, true}) {
            Mesh mesh;
            const glm::dvec2 edge = middle + side * width / 2 * across;
            for (const glm::dvec2& at :
                 {edge - 40.0 * along, edge + 40.0 * along, edge + 40.0 * along + side * 40.0 * across,
                  edge - 40.0 * along + side * 40.0 * across})
                mesh.positions.emplace_back(25, at.x, at.y);
            mesh.indices =
                (side > 0) == front ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<uint32_t>{0, 2, 1, 0, 3, 2};
            made.add(std::move(mesh), 0);
        }
    return made;
}

}  // namespace sightline::test
