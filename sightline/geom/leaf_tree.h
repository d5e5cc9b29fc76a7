// A tree of planes whose leaves hold something or nothing: what a compiled map is, and what its rays walk.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// What a leaf is for light. The values order how much it stops: the more solid of two wins where they meet.
enum class LeafContents : uint8_t {
    kEmpty,   ///< air
    kLiquid,  ///< water and its kin: another medium, seen through or not as the map was made
    kSky,     ///< open, but light from beyond it is the sky's: a sight line ends in it
    kSolid,   ///< nothing is in it
};

/// An inner node. A child below 2^31 is a node's index; from there on, kLeaf and a leaf's number.
struct LeafTreeNode {
    static constexpr uint32_t kLeaf = 1u << 31;

    glm::dvec4 plane{0.0};  ///< dot(plane, (p, 1)) >= 0 in front; the normal has length 1 but for the file's rounding
    uint32_t child[2] = {kLeaf, kLeaf};  ///< behind, in front
};

/// Parents come before their children; every node but the first is the child of exactly one.
struct LeafTree {
    std::vector<LeafTreeNode> nodes;     ///< none: leaf 0 is everything
    std::vector<LeafContents> contents;  ///< per leaf; several children may name one leaf (Quake's solid leaf 0)
    Box3d bounds;                        ///< of what the map holds; beyond it nothing is looked at
};

/// A box for each leaf that holds what of the tree's bounds is in it; empty if nothing is. Exact where planes lie across axes;
/// others do not cut. A leaf that several children name gets one box around all of it.
std::vector<Box3d> leafBoxes(const LeafTree& tree);

}  // namespace sightline
