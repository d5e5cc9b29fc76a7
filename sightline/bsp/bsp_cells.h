// The convex cells that a BSP tree's leaves are: where a point lies, which planes bound a cell, what its walls look like.
// SPDX-License-Identifier: MIT
//
// Bruce Naylor, John Amanatides, William Thibault. Merging BSP Trees Yields Polyhedral Set Operations. 1990.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bsp/bsp_tree.h"
#include "sightline/math/box.h"

namespace sightline {

/// The leaf that holds a point; of a point in a plane the leaf in front. O(depth).
uint32_t leafOf(const BspTree& tree, const glm::dvec3& point);

/// A plane of the tree as a cell's bound.
struct BspBound {
    uint32_t node = 0;
    BspSide side = kBspBack;  ///< on which the cell lies
};

/// The planes on the way to a leaf, the root's first: the cell is where all of them hold, though some may not touch it.
std::vector<BspBound> boundsOfLeaf(const BspTree& tree, uint32_t leaf);

/// A face of a cell within a box.
struct BspWall {
    static constexpr uint32_t kBox = ~0u;

    uint32_t node = kBox;             ///< whose plane it lies in, or the box
    std::vector<glm::dvec3> outline;  ///< counter-clockwise seen from inside the cell
};

/// The faces of a leaf's cell, cut off at a box; empty if nothing of the cell is left there, or if it is thinner than the
/// planes are. O(depth^2).
/// @param box  finite and not flat
std::vector<BspWall> wallsOfLeaf(const BspTree& tree, uint32_t leaf, const Box3d& box);

/// Of a closed polyhedron given by its faces. [world units cubed]
double volumeOf(const std::vector<BspWall>& walls);

}  // namespace sightline
