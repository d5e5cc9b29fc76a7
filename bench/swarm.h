// Boxes that fly about, for what lives: hierarchies, grids and worlds.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "sightline/base/random.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline::bench {

inline constexpr double kWorld = 1000.0;

/// Boxes of which every tenth is under way.
struct Swarm {
    std::vector<Box3d> boxes;
    std::vector<glm::dvec3> velocity;  ///< per mover  [world units a frame]
    uint32_t every = 10;

    Swarm(uint32_t count, uint64_t seed) {
        Random random(seed);
        const auto point = [&](double by) {
            const double x = random.uniform(-by, by), y = random.uniform(-by, by);
            return glm::dvec3(x, y, random.uniform(-by, by));
        };
        for (uint32_t i = 0; i < count; ++i) {
            const glm::dvec3 at = point(kWorld);
            const double x = random.uniform(0.5, 4), y = random.uniform(0.5, 4);
            boxes.push_back({at, at + glm::dvec3(x, y, random.uniform(0.5, 4))});
            if (i % every == 0) velocity.push_back(point(2.0));
        }
    }
    uint32_t movers() const { return static_cast<uint32_t>(velocity.size()); }
    uint32_t mover(uint32_t i) const { return i * every; }
    void step() {
        for (uint32_t i = 0; i < movers(); ++i) {
            Box3d& box = boxes[mover(i)];
            for (int axis = 0; axis < 3; ++axis)
                if (box.min[axis] + velocity[i][axis] < -kWorld || box.max[axis] + velocity[i][axis] > kWorld)
                    velocity[i][axis] = -velocity[i][axis];
            box.min += velocity[i];
            box.max += velocity[i];
        }
    }
};

inline View viewFrom(double z_far) {
    View view;
    view.view = lookAt(glm::dvec3(0.0), glm::dvec3(1, 0.1, 0.3), {0, 1, 0});
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1, z_far);
    return view;
}

/// Of everything: from far away, so that nothing is outside.
inline View viewOfAll() {
    View view;
    view.view = lookAt({0, 0, 5 * kWorld}, glm::dvec3(0.0), {0, 1, 0});
    view.projection = perspective(glm::radians(60.0), 1.0, 0.1);
    return view;
}

}  // namespace sightline::bench
