// What lies far off, or around all, and must not change how narrow a hole may be.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "sightline/base/random.h"
#include "tests/bake/marked/made_rooms.h"

namespace sightline::test {

enum class FarThing : uint8_t {
    kStray,  ///< a triangle of any size
    kDome,   ///< an octahedron around all, two-sided
    kChain,  ///< triangles each five times as far as the one before: no gap tells them from the rest
};
inline constexpr FarThing kFarThings[] = {FarThing::kStray, FarThing::kDome, FarThing::kChain};

inline void addTriangle(MarkedRooms& made, const glm::dvec3& at, double size, Random& random) {
    Mesh mesh;
    for (int c = 0; c < 3; ++c)
        mesh.positions.emplace_back(
            at + size * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    mesh.indices = {0, 1, 2};
    made.add(std::move(mesh), 0);
}

/// @param far  how far off, of a chain the last  [world units]
inline void addFarThing(MarkedRooms& made, FarThing what, double far, Random& random) {
    const auto direction = [&] {
        const double turn = random.uniform(0, 6.28), rise = random.uniform(-1, 1), flat = std::sqrt(1 - rise * rise);
        return glm::dvec3(flat * std::cos(turn), rise, flat * std::sin(turn));
    };
    if (what == FarThing::kStray) return addTriangle(made, far * direction(), random.uniform(0.01, 0.5) * far, random);
    if (what == FarThing::kChain) {
        for (double at = 100; at <= far; at *= 5) addTriangle(made, at * direction(), 0.2 * at, random);
        return;
    }
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            glm::vec3 tip(0.0f);
            tip[axis] = static_cast<float>(side * far);
            mesh.positions.push_back(tip);
        }
    for (uint32_t i = 0; i < 8; ++i) {
        mesh.indices.insert(mesh.indices.end(), {i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1)});
        mesh.indices.insert(mesh.indices.end(), {2 + (i >> 1 & 1), i & 1, 4 + (i >> 2 & 1)});
    }
    made.add(std::move(mesh), 0);
}

}  // namespace sightline::test
