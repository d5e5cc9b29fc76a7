// Keeps the items of a grid of loose cells that may touch a view frustum; cells out of its reach are not looked at.
// SPDX-License-Identifier: MIT
//
// Daniel Collin. Culling the Battlefield: Data Oriented Design in Practice. Game Developers Conference, 2011.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/geom/frustum.h"
#include "sightline/studies/frustum/grid.h"

namespace sightline::studies {

/// What a query of a grid did.
struct GridStats {
    uint64_t blocks = 0;        ///< of 64 cells, whose bounds were tested
    uint64_t cells = 0;         ///< in use and in the frustum's bounds: the only ones that were looked at
    uint64_t inside_cells = 0;  ///< whose items were kept without a test
    uint64_t items = 0;         ///< that were tested
};

/// The box around what a frustum and the cells in use have in common: what lies beside it is not looked at.
Box3d gridQueryBounds(const Frustum& frustum, const Grid& grid);

/// Writes the numbers of the items that may touch the frustum, and of all that are unbounded, and returns how many. The
/// order hangs on the grid alone. The set is, to the bit, that of cullFrustum() over the stored boxes without those that
/// lie beside gridQueryBounds(). Needs no memory.
/// Costs nothing for empty space and for cells that the frustum's bounds do not touch; for the latter to matter, the
/// view must have a far plane or the world must end.
/// @param kept  [size: >= grid.size() + 8]
size_t cullGrid(const Frustum& frustum, const Grid& grid, std::span<uint32_t> kept, GridStats* stats = nullptr);

}  // namespace sightline::studies
