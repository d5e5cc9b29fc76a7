// What a plan shows at the height of the eye: walls where they are cut, cells, and the portals between them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/plan_section.h"

#include <optional>
#include <utility>

#include "sightline/tools/report/pictures/canvas.h"

namespace sightline::tools {
namespace {

/// Where a convex outline meets the plane at which `above` is zero; none if it does not pass through.
/// @param above  of each point of the outline
/// @param point  of each point of the outline
template <class Above, class Point>
std::optional<PlanLine> cutAcross(size_t count, const Above& above, const Point& point) {
    glm::dvec3 ends[2];
    size_t found = 0;
    for (size_t i = 0; i < count; ++i) {
        const size_t next = (i + 1) % count;
        const double a = above(i), b = above(next);
        if ((a < 0) == (b < 0)) continue;
        if (found == 2) return std::nullopt;  // not convex
        ends[found++] = glm::mix(glm::dvec3(point(i)), glm::dvec3(point(next)), a / (a - b));
    }
    if (found < 2) return std::nullopt;
    return PlanLine{ends[0], ends[1]};
}

}  // namespace

std::vector<PlanLine> wallsAt(const Scene& scene, std::span<const Box3d> bounds, const PlanArea& area, double height) {
    std::vector<PlanLine> lines;
    for (size_t i = 0; i < bounds.size(); ++i) {
        const Box3d& box = bounds[i];
        if (!box.finite() || box.min.y > height || box.max.y < height || box.max.x < area.left ||
            box.min.x > area.left + area.width || box.max.z < area.top || box.min.z > area.top + area.height)
            continue;
        const SceneObject& object = scene.objects[i];
        const Mesh& mesh = scene.meshes[object.mesh];
        const glm::dmat4& to_world = object.transform;
        const glm::dvec4 plane(to_world[0].y, to_world[1].y, to_world[2].y, to_world[3].y - height);
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            const auto point = [&](size_t k) { return mesh.positions[mesh.indices[t + k]]; };
            const auto above = [&](size_t k) { return glm::dot(plane, glm::dvec4(point(k), 1)); };
            const std::optional<PlanLine> cut = cutAcross(3, above, point);
            if (!cut) continue;
            lines.push_back(
                {glm::dvec3(to_world * glm::dvec4(cut->from, 1)), glm::dvec3(to_world * glm::dvec4(cut->to, 1))});
        }
    }
    return lines;
}

PlanCells planCells(const Scene& scene) {
    PlanCells cells;
    for (const SceneCell& cell : scene.cells) cells.regions.push_back(cell.planes);
    for (const ScenePortal& portal : scene.portals) cells.portals.push_back(portal.polygon);
    return cells;
}

PlanCells planCells(const CellSpace& space) {
    PlanCells cells;
    for (uint32_t i = 0; i < space.regions.size(); ++i) {
        if (i == space.outside) continue;  // its region says nothing
        const std::span<const glm::dvec4> planes = space.planesOf(space.regions[i]);
        cells.regions.emplace_back(planes.begin(), planes.end());
    }
    for (const CellPortal& portal : space.graph.portals) {
        const std::span<const glm::dvec3> outline = space.graph.outline(portal);
        cells.portals.emplace_back(outline.begin(), outline.end());
    }
    return cells;
}

std::vector<PlanLine> cellsAt(const PlanCells& cells, const PlanArea& area, double height) {
    // Beyond the plan's own borders, which would else be drawn where a cell reaches over them.
    const glm::dvec2 low(area.left - area.width, area.top - area.height),
        high(area.left + 2 * area.width, area.top + 2 * area.height);
    std::vector<PlanLine> lines;
    for (const std::vector<glm::dvec4>& planes : cells.regions) {
        if (planes.empty()) continue;  // no solid
        std::vector<glm::dvec2> outline = {low, {high.x, low.y}, high, {low.x, high.y}};
        for (const glm::dvec4& plane : planes) cutOutline(outline, {plane.x, plane.z, plane.y * height + plane.w});
        for (size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
            lines.push_back({{a.x, height, a.y}, {b.x, height, b.y}});
        }
    }
    return lines;
}

std::vector<LeafAt> leavesAt(const LeafTree& tree, const PlanArea& area, double height) {
    const glm::dvec2 low(area.left, area.top), high(area.left + area.width, area.top + area.height);
    std::vector<LeafAt> leaves;
    struct Part {
        uint32_t child;
        std::vector<glm::dvec2> outline;
    };
    std::vector<Part> parts;
    parts.push_back({tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, {low, {high.x, low.y}, high, {low.x, high.y}}});
    while (!parts.empty()) {
        Part part = std::move(parts.back());
        parts.pop_back();
        if (part.outline.size() < 3) continue;
        if ((part.child & LeafTreeNode::kLeaf) != 0) {
            leaves.push_back({part.child & ~LeafTreeNode::kLeaf, std::move(part.outline)});
            continue;
        }
        const LeafTreeNode& node = tree.nodes[part.child];
        const glm::dvec3 line(node.plane.x, node.plane.z, node.plane.y * height + node.plane.w);
        Part front{node.child[1], part.outline}, behind{node.child[0], std::move(part.outline)};
        cutOutline(front.outline, line);
        cutOutline(behind.outline, -line);
        parts.push_back(std::move(front));
        parts.push_back(std::move(behind));
    }
    return leaves;
}

std::vector<PlanLine> portalsAt(const PlanCells& cells, double height) {
    std::vector<PlanLine> lines;
    for (const std::vector<glm::dvec3>& outline : cells.portals) {
        const auto point = [&](size_t k) { return outline[k]; };
        const auto above = [&](size_t k) { return outline[k].y - height; };
        if (const std::optional<PlanLine> cut = cutAcross(outline.size(), above, point)) lines.push_back(*cut);
    }
    return lines;
}

}  // namespace sightline::tools
