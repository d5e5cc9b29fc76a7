// A BSP tree as plain data: the polygons that it is made of, its nodes, pieces and cuts, and what moves in it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// Convex, flat polygons in world space.
struct BspPolygons {
    std::vector<glm::dvec3> points;
    std::vector<uint32_t> first{0};  ///< where a polygon's points begin, and where the last one's end
    std::vector<uint32_t> number;    ///< the caller's name for it: polygons in one plane are listed by it

    size_t size() const { return number.size(); }
    std::span<const glm::dvec3> outline(size_t i) const { return {points.data() + first[i], first[i + 1] - first[i]}; }
    /// @param outline  [size: 3 or more]
    void add(std::span<const glm::dvec3> outline, uint32_t its_number) {
        points.insert(points.end(), outline.begin(), outline.end());
        first.push_back(static_cast<uint32_t>(points.size()));
        number.push_back(its_number);
    }
};

struct BspSettings {
    uint32_t candidates = 16;   ///< polygons of a set that are tried as its splitter  [limit: >= 1]
    double split_weight = 8;    ///< a candidate's cost: this times the polygons it splits ...
    double balance_weight = 1;  ///< ... and this times the difference of the two sides; the least is taken
    uint32_t scored = 256;      ///< polygons that a candidate is tried on; of a larger set a sample  [limit: >= 1]
    bool axis_planes = true;    ///< also try the medians of the three axes: what is convex has no splitter of its own
                                ///< that divides it, and its tree would be a list. False: a true autopartition
    uint64_t seed = 1;          ///< of the candidates and the samples
    double relative_thickness = 0x1p-40;  ///< of the planes, times the largest coordinate: a point that is no farther
                                          ///< lies in the plane
};

/// A side of a plane, as an index.
enum BspSide : uint32_t { kBspBack = 0, kBspFront = 1 };

/// Back and front are what lies below: a node's index, or kLeaf and a leaf's number.
struct BspNode {
    static constexpr uint32_t kLeaf = 1u << 31;
    static constexpr uint32_t kNone = ~0u;

    glm::dvec4 plane{0.0};  ///< dot(plane, (p, 1)): the distance of p, positive in front; the normal has length 1
    uint32_t child[2] = {kNone, kNone};
    uint32_t first = 0, count = 0;  ///< the pieces that lie in the plane, by their numbers
};

/// What became of a polygon, or of a part of one.
struct BspPiece {
    uint32_t number = 0;                  ///< BspPolygons::number
    uint32_t first_point = 0, count = 0;  ///< its outline
    uint32_t cut = BspNode::kNone;        ///< the last of the cuts that made it; kNone: it is whole
    bool opposite = false;                ///< faces the other way than its node's plane
};

/// A piece lies on one side of a node's plane, having been cut there, and within the cuts before.
struct BspCut {
    uint32_t node = 0;
    BspSide side = kBspBack;
    uint32_t before = BspNode::kNone;  ///< the cut before this one, or kNone
};

/// The arrays of a tree, or of what stands in for a tree's leaves for a frame. Parents come before their children.
struct BspArrays {
    /// The numbers of nodes[0] and leaf[0]: an overlay's go on where its tree's end.
    uint32_t first_node = 0, first_leaf = 0;
    std::vector<BspNode> nodes;
    std::vector<Box3d> bounds;     ///< per node: of its pieces and of all below
    std::vector<uint32_t> below;   ///< per node: how many pieces these are
    std::vector<uint32_t> parent;  ///< per node: the parent's index * 2 + side, or kNone
    std::vector<uint32_t> leaf;    ///< per leaf: its parent's index * 2 + side, or kNone
    std::vector<BspPiece> pieces;  ///< some may be in no list any more
    std::vector<BspCut> cuts;
    std::vector<glm::dvec3> points;
    uint64_t splits = 0;      ///< of polygons or their parts
    uint64_t degenerate = 0;  ///< polygons that have no plane, or are not finite: they are left out

    std::span<const BspPiece> piecesOf(const BspNode& node) const { return {pieces.data() + node.first, node.count}; }
    std::span<const glm::dvec3> outline(const BspPiece& piece) const {
        return {points.data() + piece.first_point, piece.count};
    }
};

/// A tree. Each polygon lies in a node's plane, whole or in pieces.
///
/// A polygon is cut where it reaches beyond a plane's thickness to both sides. The crossing is computed from the
/// back end of the polygon's whole edge to the front one, from these and the plane alone: polygons that share an edge are
/// cut in the same point, bit by bit, wherever both are cut by the same plane, whatever cut them before.
struct BspTree : BspArrays {
    BspSettings settings;
    double thickness = 0;  ///< of its planes, half of it to each side [world units]
    double rounding = 0;   ///< how well distances from planes are known [world units]
    uint32_t root = BspNode::kLeaf;
    uint64_t polygons = 0;  ///< that are in it
};

/// Moving things among the static ones of a tree, for one frame: the pieces lie in nodes of the tree, or in small trees
/// that stand in for its leaves. The tree stays as it is.
struct BspOverlay : BspArrays {
    /// What lies in a node of the tree, and how far what is handed on to its children reaches.
    struct Entry {
        uint32_t node = 0;
        uint32_t first = 0, count = 0;  ///< of the overlay's pieces, by their numbers
        Box3d bounds;
    };
    std::vector<Entry> entries;
    std::vector<uint32_t> entry_of_node;  ///< per node of the tree: an entry, or kNone
    std::vector<uint32_t> root_of_leaf;   ///< per leaf of the tree: a node of the overlay, or kNone
    std::vector<uint32_t> touched_leaves;

    const Entry* entryOf(uint32_t tree_node) const {
        const uint32_t entry = tree_node < entry_of_node.size() ? entry_of_node[tree_node] : BspNode::kNone;
        return entry == BspNode::kNone ? nullptr : &entries[entry];
    }
    std::span<const BspPiece> piecesOf(const Entry& entry) const { return {pieces.data() + entry.first, entry.count}; }
    using BspArrays::piecesOf;
};

}  // namespace sightline
