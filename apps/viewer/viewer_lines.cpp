// What the viewer draws of lines: the frustum, bounds, portals, the hierarchy, the chosen object, its shadows and clusters.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "apps/viewer/inks.h"
#include "apps/viewer/viewer.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/tools/report/pictures/shadow_picture.h"
#include "sightline/tree/descend.h"
#include "sightline/world/world_state.h"

namespace sightline::viewer {
using namespace tools;
void Viewer::drawLines(const GlView& view) {
    lines_->clear();
    if (state.frozen && state.frustum) {
        const View of = cullingView();
        const glm::dmat4 back = glm::inverse(of.projection * of.view);
        glm::dvec3 corners[8];
        for (int i = 0; i < 8; ++i) {
            const glm::dvec4 near = back * glm::dvec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, -1, 1);
            corners[i] = glm::dvec3(near) / near.w;
            if ((i & 4) == 0) continue;
            // To the far end of the scene, in place of a far plane that may be infinitely far away.
            const glm::dvec3 from = eyePosition(of), ahead = corners[i] - from;
            corners[i] = isOrthographic(of) ? corners[i] + size_ * culling.forward()
                                            : from + ahead * (0.6 * size_ / std::max(glm::length(ahead), 1e-12));
        }
        lines_->hexahedron(corners, kFrustum);
    }
    if (state.bounds)
        for (const uint32_t object : culler_.visible())
            if (culler_.boundsOf(object).finite() && isShown(object)) lines_->box(culler_.boundsOf(object), kBounds);
    if (state.portals && culler_.hasCells()) drawPortals();
    if (state.cells && settings_.cells && !bounds_.empty()) drawCells();
    drawDoors();
    if (state.clusters && state.chosen) drawClusters();
    if (state.tree_level >= 0) {
        const PlacedBvh& tree = culler_.now().state().bvh;
        std::vector<std::pair<uint32_t, int>> open;
        if (tree.nodes.size() > 0) open.emplace_back(0, 0);
        while (!open.empty()) {
            const uint32_t node = open.back().first;
            const int level = open.back().second;
            open.pop_back();
            const BvhNode& children = tree.nodes[node];
            forEachSlot(usedSlots(children), [&](int slot) {
                const bool leaf = (children.child[slot] & BvhNode::kLeaf) != 0;
                if (level == state.tree_level) {
                    const Box3f box = slotBox(children, slot);
                    lines_->box({tree.origin + glm::dvec3(box.min), tree.origin + glm::dvec3(box.max)}, kTreeBox);
                } else if (!leaf) {
                    open.emplace_back(children.child[slot], level + 1);
                }
            });
        }
    }
    if (state.chosen && culler_.boundsOf(*state.chosen).finite()) {
        const Box3d& box = culler_.boundsOf(*state.chosen);
        lines_->box(box, kChosen);
        // Whether something stands in between is seen along the lines from the culling camera.
        if (state.frozen && !isOrthographic(cullingView()))
            for (int i = 0; i < 8; ++i)
                lines_->line(
                    culling.eye(),
                    {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z},
                    0.7f * kChosen);
        if (state.shadows && !state.why_is_old) drawShadows(box);
    }
    lines_->draw(view, 0.25f);
}

/// All portals, and in another colour those that a cell is seen through.
void Viewer::drawPortals() {
    const PortalGraph& graph = culler_.now().state().cell_state.cells->graph;
    const PortalCorners corners = graph.corners();
    std::vector<uint32_t> seen;
    for (const SeenWindow& window : culler_.windows()) seen.push_back(window.portal);
    std::sort(seen.begin(), seen.end());
    std::vector<glm::dvec3> points;
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& portal : graph.portalsFrom(cell)) {
            points.clear();
            for (uint32_t i = portal.first; i < portal.first + portal.count; ++i)
                points.emplace_back(corners.x[i], corners.y[i], corners.z[i]);
            const bool through = std::binary_search(seen.begin(), seen.end(), portal.portal);
            lines_->outline(points, through ? kSeenThrough : portal.door == CellPortal::kNone ? kPortal : kDoor);
        }
}

/// The faces of the cell that the culling camera is in, and of those that are seen from there.
void Viewer::drawCells() {
    if (!cell_faces_) {
        Box3d around = bounds_;
        around.min -= 0.01 * size_;
        around.max += 0.01 * size_;
        cell_faces_.emplace(*settings_.cells, around);
    }
    std::vector<uint32_t> eye_cells, seen;
    for (const SeenWindow& window : culler_.windows())
        (window.from == SeenWindow::kNone ? eye_cells : seen).push_back(window.cell);
    for (std::vector<uint32_t>* cells : {&seen, &eye_cells}) {
        std::sort(cells->begin(), cells->end());
        cells->erase(std::unique(cells->begin(), cells->end()), cells->end());
        for (const uint32_t cell : *cells)
            for (const CellFaces::Outline& face : cell_faces_->of(cell))
                lines_->outline(face, cells == &seen ? kSeenCell : kEyeCell);
    }
}

/// A door that is shut hides what is behind it, wherever its leaf stands: so its portals are filled. The one that the mouse is
/// at in the list is outlined.
void Viewer::drawDoors() {
    const std::vector<ViewerDoor>& doors = culler_.doors();
    for (size_t i = 0; i < doors.size(); ++i)
        for (const std::vector<glm::dvec3>& portal : doors[i].portals) {
            if (doors[i].open <= 0) lines_->face(portal, kShut);
            if (state.door == i) lines_->outline(portal, kAtDoor);
        }
}

/// The clusters of the chosen object, and one's culling volume.
void Viewer::drawClusters() {
    if (!clusters_ || clusters_->object() != *state.chosen) clusters_.emplace(scene_, *state.chosen);
    clusters_->addEdges(cullingView(), *lines_);
    if (state.cluster >= 0 && static_cast<size_t>(state.cluster) < clusters_->withBacks())
        clusters_->addVolume(static_cast<size_t>(state.cluster), *lines_);
}

/// The parts that hide the chosen object; from outside of the frozen camera also their shadows.
void Viewer::drawShadows(const Box3d& box) {
    const glm::dvec3 eye = culling.eye();
    for (const std::vector<glm::dvec3>& outline : state.outlines) {
        lines_->outline(outline, kHider);
        if (!state.frozen) continue;
        const std::vector<glm::dvec3> ends = shadowEnd(eye, outline, shadowReach(eye, box, outline));
        lines_->outline(ends, 0.8f * kHider);
        for (size_t i = 0; i < outline.size(); ++i) {
            lines_->line(eye, outline[i], 0.5f * kHider);
            lines_->line(outline[i], ends[i * ends.size() / outline.size()], 0.8f * kHider);
        }
    }
}

}  // namespace sightline::viewer
