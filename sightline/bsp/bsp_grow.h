// Grows a BSP tree from a set of polygons, in a tree's own arrays or in an overlay's.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/bsp/bsp_piece.h"
#include "sightline/bsp/bsp_tree.h"

namespace sightline {

/// A polygon, or a part of one, on its way down.
struct BspFalling {
    uint32_t polygon = 0;                 ///< of the input
    uint32_t first_point = 0, count = 0;  ///< of the grower's points
    uint32_t cut = BspNode::kNone;
    double uncertainty = 0;  ///< of its corners [world units]
};

/// What building, inserting and locating have in common.
class BspGrower {
public:
    BspGrower(BspArrays& arrays, const BspPolygons& input, const BspSettings& settings, double thickness,
              double rounding);

    /// All polygons that have a plane; the others are counted as degenerate.
    std::vector<BspFalling> takeAll();

    /// Hands pieces past a plane: appends to the sets of its two sides and to that of what lies in it. Pieces that are
    /// split get a cut.
    /// @param node  whose plane it is
    void part(const std::vector<BspFalling>& pieces, uint32_t node, const glm::dvec4& plane,
              std::vector<BspFalling> sides[2], std::vector<BspFalling>& in_plane);

    /// Makes a tree of the pieces.
    /// @param slot  the parent's index * 2 + side, or kNone
    /// @param leaf  a leaf's number that has become free, or kNone
    /// @returns what the parent's child is to be: a node, or a leaf if there are no pieces
    uint32_t grow(std::vector<BspFalling> pieces, uint32_t slot, uint32_t leaf);

    /// Writes pieces that lie in a plane to the end of the array, together with those that are there already.
    void place(const std::vector<BspFalling>& in_plane, const glm::dvec4& plane, std::vector<BspPiece> already,
               uint32_t& first, uint32_t& count);

    Box3d boundsOf(const std::vector<BspFalling>& pieces) const;

private:
    struct Candidate {
        glm::dvec4 plane{0.0};
        uint32_t piece = BspNode::kNone;  ///< kNone: an axis plane
    };
    std::span<const glm::dvec3> outline(const BspFalling& piece) const {
        return {points_.data() + piece.first_point, piece.count};
    }
    const BspFalling& scored(const std::vector<BspFalling>& pieces, uint32_t i) const;
    double costOf(const std::vector<BspFalling>& pieces, const Candidate& candidate) const;
    Candidate medianPlane(const std::vector<BspFalling>& pieces, int axis) const;
    Candidate choose(const std::vector<BspFalling>& pieces);
    bool divides(const std::vector<BspFalling>& pieces, const glm::dvec4& plane) const;
    uint32_t makeLeaf(uint32_t slot);

    BspArrays& arrays_;
    const BspPolygons& input_;
    const BspSettings& settings_;
    double thickness_, rounding_;
    std::vector<glm::dvec4> planes_;  ///< per polygon of the input
    std::vector<glm::dvec3> points_;
    std::vector<uint32_t> line_of_point_;  ///< per point: the line of the edge that begins there
    std::vector<BspLine> lines_;
    BspOutline parts_[2];
    uint32_t free_leaf_ = BspNode::kNone;
    Random random_;
};

}  // namespace sightline
