// The section of a tree of planes whose leaves are cells.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/visfile/placed_parts.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

namespace visibility_file {

/// nodes, leaves: 4 bytes each; bounds (48); per node its plane (32), the child behind and the one in front (4 each);
/// per leaf its contents (1).
inline constexpr uint32_t kTree = section_file::tagOf("tree");

}  // namespace visibility_file

/// As many nodes may lie above a leaf: who walks down need not fear a made file.
inline constexpr uint32_t kDeepestTreeInFile = 4096;

/// Errors (kUsage): what a reader would refuse.
Result<Array<char>> treeSection(const LeafTree& tree, Memory* memory = defaultMemory());

/// A tree where it lies.
class PlacedTree {
public:
    /// Whatever the bytes are, what is opened is a tree: parents before their children, each node but the first the child
    /// of one, planes that have a direction. Takes 2 bytes a node while it looks.
    /// @param file  what errors call the bytes
    /// @param at    their place in it
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<PlacedTree> open(std::span<const char> bytes, std::string_view file, uint64_t at = 0,
                                   Memory* memory = defaultMemory());

    uint32_t nodes() const { return nodes_; }
    uint32_t leaves() const { return leaves_; }
    LeafTree tree() const;  ///< a copy; without contents if nothing was opened

private:
    LeafTreeNode node(uint32_t i) const;

    uint32_t nodes_ = 0, leaves_ = 0;
    PlacedNumbers<double> bounds_;
    std::span<const char> node_bytes_;
    PlacedNumbers<uint8_t> contents_;
};

}  // namespace sightline
