// The cells and portals of a tree of planes: every hole between two leaves, however thin.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/cells/cells.h"
#include "sightline/geom/leaf_tree.h"

namespace sightline {

struct TreePortalSettings {
    bool sky_is_open = false;  ///< sky leaves are cells as well; else a sight line ends in them as in a wall
    bool contents_stop =
        false;  ///< no portal joins leaves of different contents: water is a wall, seen from either side
};

/// What became of the faces between leaves.
struct TreePortalCounts {
    double tolerance = 0;   ///< how far a portal may reach beyond a face's planes [world units]
    uint64_t slivers = 0;   ///< portals of faces so thin that only exact arithmetic tells them from nothing
    uint64_t touching = 0;  ///< parts of faces that were dropped: exactly, they are a line, a point, or nothing
    uint64_t doubtful = 0;  ///< portals kept since too many planes come together there to be sure that they are nothing
    uint64_t same_leaf = 0;  ///< faces between parts of one leaf: no portals
};

/// A cell of each leaf of the tree that is not solid, numbered as the leaves are, and a portal of each face that two of them
/// share. Leaves that no node names are none of it.
///
/// A face is what the closed regions of two leaves have in common of a node's plane, within the tree's bounds, the
/// planes being exactly as they are given. Each face of positive area becomes one portal, convex, in the plane of its
/// node, that holds every point of the face with some room to spare: at least an eighth of the tolerance to each side. It reaches beyond
/// none of the planes of either leaf by more than the tolerance, which is 2^-38 of the largest coordinate that occurs in
/// the computation (about 1e-7 in a world of +-4096), unless the tree is more than a hundred levels deep. Where planes meet at a sharp angle
/// a corner reaches farther, as corners of wider outlines do.
///
/// O(nodes * depth + faces), as trees of maps are.
/// @param tree    finite; its bounds, too
/// @param counts  receives what became of the faces, if there is one
/// @param node_of_portal  receives in which node's plane each portal lies, if there is one
CellGraph cellsOfTree(const LeafTree& tree, const TreePortalSettings& settings = {}, TreePortalCounts* counts = nullptr,
                      std::vector<uint32_t>* node_of_portal = nullptr);

}  // namespace sightline
