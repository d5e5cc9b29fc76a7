// Segments through the brushes of a map's source, as its text has them: what the file itself says of who sees whom.
//
// A witness: it reads the planes by itself, and shares no code with what makes trees, portals or rows of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/truth/aimed_holes.h"
#include "sightline/tools/truth/row_check.h"

namespace sightline::tools {

class BrushRays {
public:
    /// Reads the brushes that stop sight.
    /// @param text    of a `.map`; sides must stand on lines of their own, as editors write them
    /// @param stops   of each brush in the text's order, patches left out: whether sight ends in it
    /// @param slack   a tree may have moved the corners of faces by so much  [world units] [>= 0]
    /// Errors (kInput): the text has another number of brushes.
    static Result<BrushRays> read(std::string_view text, std::span<const uint8_t> stops, double slack);

    /// A brush counts as larger by this on all sides, for planes that a tree took for one another: twice the slack, and
    /// rounding of the brush's own largest coordinate.  [world units]
    /// @param brush  of those that stop sight, in the text's order
    double growth(size_t brush) const { return brushes_[brush].growth; }
    /// How far a tree's faces may lie from where they should at a point: what is shorter there tells nothing.  [world units]
    double growthAt(const glm::dvec3& point) const;
    size_t brushes() const { return brushes_.size(); }
    /// A random point near a side of a brush, in the open or not.
    glm::dvec3 pointNearSide(Random& random) const;
    /// How far a segment comes: the parameter where it enters a brush, 0 if it begins in one, 1 at its end.
    double follow(const glm::dvec3& a, const glm::dvec3& b) const;

private:
    struct Brush {
        uint32_t first = 0, count = 0;  // of planes
        double growth = 0;
    };
    /// A box of space: eight smaller ones from `first` on, or a list.
    struct Node {
        Box3d box;
        uint32_t first = 0, count = 0;
        bool divided = false;
    };
    double largestOf(const Brush& brush) const;
    void grow();
    void divide();
    bool meets(const Brush& brush, const Box3d& box) const;

    std::vector<glm::dvec4> planes_;  // facing out
    std::vector<glm::dvec3> points_;  // of sides, three each
    std::vector<Brush> brushes_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> lists_;
    Box3d bounds_;
    double slack_ = 0;
};

/// What the brushes had to say.
struct BrushReport {
    RowReport rows;
    std::vector<RowMiss>
        solid;  ///< leaves of the tree that stop sight where no brush does, each once, with a segment: the
                ///< tree is wrong. `row` and `column` are the leaf
};

/// Holds a tree, and rows of its leaves or of what these belong to, against segments in the open of the brushes: through any
/// point, through points of holes, and close by sides of brushes; each both ways until a brush stops it. Seeded, as
/// checkLeafRows().
/// @param row_of_leaf  or RowJudge::kNoRow  [size: leaves]
BrushReport checkBrushRows(const BrushRays& rays, const LeafTree& tree, const BitMatrix& rows,
                           std::span<const uint32_t> row_of_leaf, const AimedHoles& holes,
                           const RowCheckSettings& settings = {});

}  // namespace sightline::tools
