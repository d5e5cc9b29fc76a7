// The faces of convex cells, for pictures: what their planes leave of a box.
// SPDX-License-Identifier: MIT
#include "apps/viewer/cell_faces.h"

#include <utility>

#include "sightline/bake/brushes/brush_planes.h"

namespace sightline::viewer {

CellFaces::CellFaces(const CellSpace& space, const Box3d& box) : faces_(space.graph.cells) {
    if (space.ofTree()) cutTree(space, box);
    for (uint32_t cell = 0; cell < space.regions.size(); ++cell)
        if (cell != space.outside) cutRegion(space.planesOf(space.regions[cell]), box, faces_[cell]);
}

void CellFaces::cutTree(const CellSpace& space, const Box3d& box) {
    const LeafTree& tree = space.tree;
    if (tree.nodes.size() > kMostNodes) return;
    std::vector<std::pair<uint32_t, bake::BrushFaces>> open;
    open.emplace_back(tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, bake::facesOfBox(box));
    while (!open.empty()) {
        const auto [child, faces] = std::move(open.back());
        open.pop_back();
        if (faces.size() < 4) continue;  // nothing of it lies in the box
        if ((child & LeafTreeNode::kLeaf) == 0) {
            const LeafTreeNode& node = tree.nodes[child];
            bake::BrushFaces behind, in_front;
            bake::cutFaces(faces, node.plane, box, behind, in_front);
            open.emplace_back(node.child[0], std::move(behind));
            open.emplace_back(node.child[1], std::move(in_front));
            continue;
        }
        const uint32_t leaf = child & ~LeafTreeNode::kLeaf;
        const uint32_t cell = space.graph.cell_of_leaf.empty() ? leaf : space.graph.cell_of_leaf[leaf];
        if (cell >= faces_.size()) continue;  // solid
        for (const bake::BrushFace& face : faces) faces_[cell].push_back(face.outline);
    }
}

void CellFaces::cutRegion(std::span<const glm::dvec4> planes, const Box3d& box, std::vector<Outline>& faces) const {
    std::vector<glm::dvec4> all;  // facing out
    for (const glm::dvec4& plane : planes) all.push_back(-plane);
    for (const bake::BrushFace& face : bake::facesOfBox(box)) all.push_back(face.plane);
    for (size_t i = 0; i < all.size(); ++i) {
        std::vector<glm::dvec4> others = all;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        Outline outline = bake::faceIn(all[i], box, others);
        if (outline.size() >= 3) faces.push_back(std::move(outline));
    }
}

}  // namespace sightline::viewer
