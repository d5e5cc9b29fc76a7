// Which hiders a segment crosses: a tree of boxes over them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/bake/view_cells/flat_hiders.h"
#include "sightline/tree/bvh.h"

namespace sightline::bake {

/// A hider that a segment crosses, and how far along.
struct Crossed {
    double at = 0;  ///< from 0 to 1
    uint32_t hider = 0;
};

class HiderTree {
public:
    /// @param hiders  must outlive this
    explicit HiderTree(std::span<const FlatHider> hiders);

    /// The hiders that a segment comes to from in front and leaves behind, up to rounding: what is found is a proposal.
    /// @param most   so many of them at most, the nearest
    /// @param found  receives them, the nearest first; empty before
    /// @returns how many nodes were opened
    uint32_t crossed(const glm::dvec3& from, const glm::dvec3& to, size_t most, std::vector<Crossed>& found) const;

private:
    std::span<const FlatHider> hiders_;
    Bvh tree_;
};

}  // namespace sightline::bake
