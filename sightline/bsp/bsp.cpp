// A binary space partition of convex polygons by their own planes: an order of visibility for every eye, and convex cells.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#include "sightline/bsp/bsp.h"

#include <algorithm>
#include <cmath>

#include "sightline/bsp/bsp_grow.h"

namespace sightline {
namespace {

/// Planes are as thick as the largest coordinate asks for.
void widen(BspTree& tree, const BspPolygons& polygons) {
    double largest = 0;
    for (const glm::dvec3& p : polygons.points)
        for (int axis = 0; axis < 3; ++axis)
            if (std::isfinite(p[axis])) largest = std::max(largest, std::abs(p[axis]));
    tree.thickness = std::max(tree.thickness, largest * tree.settings.relative_thickness);
    tree.rounding = std::max(tree.rounding, largest * 0x1p-49);
}

/// A set of pieces on its way down, and where it has come to.
struct Falling {
    std::vector<BspFalling> pieces;
    uint32_t child = 0;
    uint32_t slot = BspNode::kNone;
};

/// Hands pieces down a tree. Calls in(node, set) with what comes by a node, lies(node, set) with what lies in its plane,
/// ends(leaf, slot, set) with what reaches a leaf.
template <class In, class Lies, class Ends>
void handDown(const BspTree& tree, BspGrower& grower, In&& in, Lies&& lies, Ends&& ends) {
    std::vector<Falling> stack;
    stack.push_back({grower.takeAll(), tree.root, BspNode::kNone});
    while (!stack.empty()) {
        Falling falling = std::move(stack.back());
        stack.pop_back();
        if (falling.pieces.empty()) continue;
        if ((falling.child & BspNode::kLeaf) != 0) {
            ends(falling.child & ~BspNode::kLeaf, falling.slot, std::move(falling.pieces));
            continue;
        }
        const uint32_t at = falling.child;
        in(at, falling.pieces);
        std::vector<BspFalling> sides[2], in_plane;
        grower.part(falling.pieces, at, tree.nodes[at].plane, sides, in_plane);
        if (!in_plane.empty()) lies(at, in_plane);
        for (const BspSide side : {kBspBack, kBspFront})
            stack.push_back({std::move(sides[side]), tree.nodes[at].child[side], at << 1 | side});
    }
}

}  // namespace

BspTree buildBsp(const BspPolygons& polygons, const BspSettings& settings) {
    BspTree tree;
    tree.settings = settings;
    widen(tree, polygons);
    BspGrower grower(tree, polygons, settings, tree.thickness, tree.rounding);
    std::vector<BspFalling> pieces = grower.takeAll();
    tree.polygons = pieces.size();
    tree.root = grower.grow(std::move(pieces), BspNode::kNone, BspNode::kNone);
    return tree;
}

void insertPolygons(BspTree& tree, const BspPolygons& polygons) {
    const uint64_t degenerate = tree.degenerate;
    widen(tree, polygons);
    BspGrower grower(tree, polygons, tree.settings, tree.thickness, tree.rounding);
    const auto addBelow = [&](uint32_t slot, uint32_t count) {
        for (; slot != BspNode::kNone; slot = tree.parent[slot >> 1]) tree.below[slot >> 1] += count;
    };
    handDown(
        tree, grower,
        [&](uint32_t node, const std::vector<BspFalling>& pieces) { tree.bounds[node].grow(grower.boundsOf(pieces)); },
        [&](uint32_t at, const std::vector<BspFalling>& pieces) {
            BspNode& node = tree.nodes[at];
            const std::span<const BspPiece> already = tree.piecesOf(node);
            grower.place(pieces, node.plane, {already.begin(), already.end()}, node.first, node.count);
            addBelow(at << 1, static_cast<uint32_t>(pieces.size()));
        },
        [&](uint32_t leaf, uint32_t slot, std::vector<BspFalling> pieces) {
            const uint32_t made = grower.grow(std::move(pieces), slot, leaf);
            if (slot == BspNode::kNone) tree.root = made;
            else tree.nodes[slot >> 1].child[slot & 1] = made;
            addBelow(slot, tree.below[made]);
        });
    tree.polygons += polygons.size() - (tree.degenerate - degenerate);
}

void locatePolygons(const BspTree& tree, const BspPolygons& moving, BspOverlay& overlay) {
    for (const BspOverlay::Entry& entry : overlay.entries)
        if (entry.node < overlay.entry_of_node.size()) overlay.entry_of_node[entry.node] = BspNode::kNone;
    for (const uint32_t leaf : overlay.touched_leaves) overlay.root_of_leaf[leaf] = BspNode::kNone;
    overlay.entry_of_node.resize(tree.nodes.size(), BspNode::kNone);
    overlay.root_of_leaf.resize(tree.leaf.size(), BspNode::kNone);
    overlay.first_node = static_cast<uint32_t>(tree.nodes.size());
    overlay.first_leaf = static_cast<uint32_t>(tree.leaf.size());
    overlay.nodes.clear();
    overlay.bounds.clear();
    overlay.below.clear();
    overlay.parent.clear();
    overlay.leaf.clear();
    overlay.pieces.clear();
    overlay.cuts.clear();
    overlay.points.clear();
    overlay.entries.clear();
    overlay.touched_leaves.clear();
    overlay.splits = overlay.degenerate = 0;
    BspTree extent;
    extent.settings = tree.settings;
    widen(extent, moving);
    BspGrower grower(overlay, moving, tree.settings, std::max(tree.thickness, extent.thickness),
                     std::max(tree.rounding, extent.rounding));
    handDown(
        tree, grower,
        [&](uint32_t node, const std::vector<BspFalling>& pieces) {
            overlay.entry_of_node[node] = static_cast<uint32_t>(overlay.entries.size());
            overlay.entries.push_back({node, 0, 0, grower.boundsOf(pieces)});
        },
        [&](uint32_t node, const std::vector<BspFalling>& pieces) {
            BspOverlay::Entry& entry = overlay.entries[overlay.entry_of_node[node]];
            grower.place(pieces, tree.nodes[node].plane, {}, entry.first, entry.count);
        },
        [&](uint32_t leaf, uint32_t slot, std::vector<BspFalling> pieces) {
            overlay.root_of_leaf[leaf] = grower.grow(std::move(pieces), slot, BspNode::kNone);
            overlay.touched_leaves.push_back(leaf);
        });
}

BspStatistics statisticsOf(const BspTree& tree) {
    BspStatistics result;
    result.polygons = tree.polygons;
    result.degenerate = tree.degenerate;
    result.splits = tree.splits;
    result.nodes = tree.nodes.size();
    result.leaves = tree.leaf.size();
    std::vector<uint32_t> depth(tree.nodes.size(), 1);
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        if (tree.parent[i] != BspNode::kNone) depth[i] = depth[tree.parent[i] >> 1] + 1;
        result.depth = std::max(result.depth, depth[i]);
        result.pieces += tree.nodes[i].count;
    }
    for (const uint32_t slot : tree.leaf)
        if (slot != BspNode::kNone) result.mean_depth += depth[slot >> 1] / static_cast<double>(tree.leaf.size());
    if (result.polygons > 0)
        result.pieces_per_polygon = static_cast<double>(result.pieces) / static_cast<double>(result.polygons);
    return result;
}

}  // namespace sightline
