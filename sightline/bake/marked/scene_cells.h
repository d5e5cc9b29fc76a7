// Turns marked cells and portals into cells that are safe: walls are checked, and holes become portals.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/marked/cell_report.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// Makes rows that see the outside see all cells: walls may be drawn from within alone, so that from outside they hide
/// nothing. The outside itself loses its row, for a cell without a row sees all.
/// @param visible  symmetric, of the rows that space.row_of_cell names
/// @returns the rows that see the outside, itself included, rising; none without an outside
std::vector<uint32_t> seeAllFromOutside(CellSpace& space, BitMatrix& visible);

/// Makes cells of the marked ones, so that a sight line that leaves a cell either meets a drawn, opaque front or passes
/// a portal. Holes in walls that nobody marked become portals; docs/techniques/cells.md has the argument.
///
/// Not sound for slits narrower than `slit`, or `bend` between the sheets of a wall; for trusted cells that are marked
/// wrongly; and once an object of SceneCellReport::walls is moved or hidden.
///
/// A scene without cells gives a space without cells. O(cells * objects + triangles near cells * pieces of their
/// faces).
SceneCells cellsOfScene(const Scene& scene, const SceneCellSettings& settings = {});

}  // namespace sightline::bake
