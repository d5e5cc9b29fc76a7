// Where one can walk in a scene: places on a floor, a step apart, and which of them lead to each other.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// A grid of places that can be reached from the first one on foot: over floors and stairs, upright, past walls.
struct WalkFloor {
    struct Place {
        glm::dvec3 foot;
        double room = 0;             ///< free around the head, as far as it was looked  [world units]
        double view = 0;             ///< how far one sees on average, as far as it was looked  [world units]
        std::vector<uint32_t> next;  ///< indices into places
    };

    double unit = 1;               ///< what a metre is; other than 1 if rooms are so high that the unit cannot be one
    double spacing = 0;            ///< of the grid: more where the view is wide  [world units]
    double climb = 0;              ///< between two places that lead to each other, at most  [world units]
    std::optional<double> ground;  ///< taken for a floor where there is none below
    std::vector<Place> places;

    /// The eye of one who stands there.
    glm::dvec3 eye(uint32_t place) const { return places[place].foot + glm::dvec3(0, 1.6 * unit, 0); }
};

/// The floor around a start that the seed chooses among places from which surfaces are seen all around: in rooms and
/// streets rather than on roofs. Where rooms or streets have no floor, the ground is where objects begin. At most 2500
/// places, the nearest ones. None at all where there is nothing to walk on: a car, a statue, an engine. The same on
/// every machine.
WalkFloor findFloor(const Scene& scene, const RayProbe& probe, uint64_t seed);

}  // namespace sightline::tools
