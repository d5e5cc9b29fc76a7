// A binary space partition of convex polygons by their own planes: an order of visibility for every eye, and convex cells.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
// Enric Torres. Optimization of the Binary Space Partition Algorithm for the Visualization of Dynamic Scenes. 1990.
#pragma once

#include <cstdint>

#include "sightline/bsp/bsp_tree.h"

namespace sightline {

/// O(n log n) for scenes; O(n^2) pieces at worst. Deterministic for a seed.
BspTree buildBsp(const BspPolygons& polygons, const BspSettings& settings = {});

/// Adds polygons to a tree: they are handed down from the root, and leaves that they reach become trees. The numbers of
/// leaves that are left stay. O(polygons * depth).
void insertPolygons(BspTree& tree, const BspPolygons& polygons);

/// Places moving polygons. What the overlay held is gone; its memory is used again.
void locatePolygons(const BspTree& tree, const BspPolygons& moving, BspOverlay& overlay);

struct BspStatistics {
    uint64_t polygons = 0;  ///< in the tree
    uint64_t degenerate = 0;
    uint64_t pieces = 0;  ///< = polygons + splits
    uint64_t splits = 0;
    uint64_t nodes = 0, leaves = 0;
    uint32_t depth = 0;     ///< nodes on the longest way down
    double mean_depth = 0;  ///< of the leaves
    double pieces_per_polygon = 0;
};

BspStatistics statisticsOf(const BspTree& tree);

}  // namespace sightline
