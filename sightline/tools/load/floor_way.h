// A way over a floor, from room to room.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/load/floor.h"

namespace sightline::tools {

/// A way over the floor, as positions of the eye: each time to the place farthest away of those where it has not been,
/// rather along the middle of a room than along its walls, until it is `length` long or has been everywhere; one
/// leg at least. No surface lies between two positions in turn. Empty if the floor has fewer than two places.
std::vector<glm::dvec3> wayOver(const WalkFloor& floor, const RayProbe& probe, double length);

}  // namespace sightline::tools
