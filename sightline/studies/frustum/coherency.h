// What a coherent walk over a hierarchy may use, and what it counts.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/cull/bounds.h"

namespace sightline::studies {

/// What a walk may use. Apart from the refinement, none changes which items are kept; each can be tried alone.
struct HierarchyCulling {
    bool eight_at_once = true;  ///< SIMD across a node's children; octant and the coherencies are not used then
    bool inside = true;         ///< a child inside all planes is kept with all below it, unasked
    bool masking = true;        ///< a plane that a node is inside of is not asked of its children
    bool octant =
        false;  ///< of two opposite planes the one nearer to the child's centre is asked; the other only if that
                ///< one's answer leaves it open
    bool plane_coherency = false;  ///< the plane that culled a child last time is asked first
    bool translation = false;      ///< a child that was culled stays so, as long as the eye has not come near enough
    bool rotation = false;         ///< and as long as the view has not turned far enough
    Refinement refinement = Refinement::kNone;  ///< of children that cross a plane
    float large = 0.0f;                         ///< only of children with a side of at least this much  [world units]

    bool coherent() const { return plane_coherency || translation || rotation; }
};

/// What a walk did.
struct CoherentStats {
    uint64_t nodes = 0;        ///< visited
    uint64_t boxes = 0;        ///< children and items that were asked about
    uint64_t plane_tests = 0;  ///< a box against a plane
    uint64_t unmoved = 0;      ///< boxes culled from memory, by translation and rotation coherency
    uint64_t refined = 0;      ///< boxes culled by the refinement
};

}  // namespace sightline::studies
