// The walls, slabs and ceilings of a procedural building: one closed surface, cut into named parts.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sightline/tools/scene/building/plan.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::building {

/// The faces of one room, or of the outside of one floor, that look one way.
struct ShellPart {
    uint32_t floor = 0;        ///< index into Plan::floors
    uint32_t room = kOutside;  ///< index into Floor::rooms; kOutside: the facade, the ground
    std::string name;          ///< "North wall", "Ceiling", "Facade south"
    Mesh mesh;                 ///< in the world's coordinates
};

/// All that is solid is what is left of the footprint and the ground once rooms, shafts and openings are taken out.
/// Its surface is cut into rectangles, and each rectangle into triangles at the corners of its neighbours: all parts
/// together have every edge exactly once in each direction, with equal positions, bit for bit.
std::vector<ShellPart> makeShell(const Plan& plan);

/// Triangles between the corners of a convex outline of which corners may lie on straight lines, none degenerate.
/// @param outline  counter-clockwise; the first corner is the least in (x, then y), and a true one
std::vector<std::array<uint32_t, 3>> triangulateConvex(const std::vector<glm::dvec2>& outline);

}  // namespace sightline::tools::building
