// A tree of planes from the brushes of a map's source: constructive geometry, region by region.
// SPDX-License-Identifier: MIT
//
// William Thibault, Bruce Naylor. Set Operations on Polyhedra Using Binary Space Partitioning Trees. 1987.
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/bake/brushes/brush_role.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/scene/quake_map.h"

namespace sightline::bake {
using namespace tools;

struct BrushTreeSettings {
    BrushRules rules = {};
    /// Planes of brushes that are so close, and all but parallel, are one: what was drawn on two grids closes. It
    /// moves faces, by so much at most at each corner: what is known of the result is known of the moved brushes.
    /// [world units]
    double snap_distance = 0.01;
    /// Regions larger than this are first divided along this grid, whatever is in them: small ones are faster, and make
    /// more cells. [world units]
    double block = 4096;
    double margin = 24;        ///< how far the bounds reach beyond the brushes: there it is outside [world units] [> 0]
    uint32_t candidates = 64;  ///< planes that are tried for each division [>= 1]
};

struct BrushTreeCounts {
    uint64_t solid = 0, sky = 0, liquid = 0, nothing = 0;  ///< brushes, by what they are
    uint64_t empty = 0;                                    ///< brushes of them that hold no volume: left out
    uint64_t open_ended = 0;                               ///< brushes that have no end: cut off at the bounds
};

struct BrushTree {
    LeafTree tree;
    std::vector<uint32_t> edge_leaves;    ///< not solid, and at the bounds: from there it is outside
    std::vector<glm::dvec3> edge_points;  ///< of each of them, a point on the bounds
    double tolerance = 0;  ///< what a brush reaches into a leaf by less may be missing there  [world units]
    BrushTreeCounts counts;
    BrushRoles roles;
};

/// The tree of the world's brushes. A leaf is solid only if it lies in one solid brush, but for a gap of 1.5e-7 and
/// 2^-46 of the largest coordinate. A brush that reaches into a leaf by less than the tolerance, 2^-36 of the largest
/// coordinate, may be missing there. What is only detail, moves, or is no obstacle, is not in the tree: more may then be
/// seen through it than in truth, never less. Where brushes overlap, solid is stronger than sky and sky than liquids.
///
/// The planes are those of the brushes: first the one that divides the fewest of them and has the most sides in it,
/// axial ones before others. Deterministic. O(brushes * depth * candidates), as maps are.
BrushTree treeOfBrushes(const QuakeMap& map, const BrushTreeSettings& settings = {});

}  // namespace sightline::bake
