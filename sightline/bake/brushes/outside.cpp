// The flood from outside: breadth first, so that the first way found is one of the fewest portals.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/outside.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/tree_portals.h"

namespace sightline::bake {
using namespace tools;
namespace {

constexpr uint32_t kNone = ~0u;

uint32_t leafAt(const LeafTree& tree, const glm::dvec3& point) {
    uint32_t child = tree.nodes.empty() ? LeafTreeNode::kLeaf : 0;
    while ((child & LeafTreeNode::kLeaf) == 0) {
        const LeafTreeNode& node = tree.nodes[child];
        child = node.child[glm::dot(node.plane, glm::dvec4(point, 1)) >= 0];
    }
    return child & ~LeafTreeNode::kLeaf;
}

std::optional<glm::dvec3> quakeOrigin(std::string_view value) {
    double x = 0, y = 0, z = 0;
    char rest = 0;
    const std::string text(value);
    if (std::sscanf(text.c_str(), "%lf %lf %lf %c", &x, &y, &z, &rest) != 3) return std::nullopt;
    if (!(std::abs(x) <= 1e9 && std::abs(y) <= 1e9 && std::abs(z) <= 1e9)) return std::nullopt;
    return glm::dvec3(x, z, -y);
}

/// The width of an outline: the least distance of two parallel lines with the outline between them. One of them lies
/// along an edge.
double widthOf(std::span<const glm::dvec3> outline, const glm::dvec3& normal) {
    double width = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 < outline.size() ? i + 1 : 0] - outline[i];
        const double length = glm::length(edge);
        if (!(length > 1e-6)) continue;  // too short for a direction
        const glm::dvec3 inward = glm::cross(normal, edge) / length;
        double most = 0;
        for (const glm::dvec3& point : outline) most = std::max(most, glm::dot(inward, point - outline[i]));
        width = std::min(width, most);
    }
    return std::isfinite(width) ? width : 0;
}

/// How the flood came to a cell.
struct Reach {
    uint32_t portal = kNone;  // through it; kNone: from beyond the bounds
    uint32_t from = kNone;    // the cell before, or the edge leaf's place in its list
    bool reached = false;
};

class Flood {
public:
    Flood(const CellGraph& graph, const BrushTree& brushes, double least_way)
        : graph_(graph), brushes_(brushes), reach_(graph.cells) {
        std::vector<std::vector<uint32_t>> portals(graph.cells);
        for (uint32_t i = 0; i < graph.portals.size(); ++i)
            if (!(widthOf(graph.outline(graph.portals[i]), glm::dvec3(graph.portals[i].plane)) < least_way))
                for (const uint32_t cell : graph.portals[i].cells) portals[cell].push_back(i);
        for (uint32_t i = 0; i < brushes.edge_leaves.size(); ++i) {
            const uint32_t cell = graph.cell_of_leaf[brushes.edge_leaves[i]];
            if (cell != CellGraph::kNoCell) take(cell, kNone, i);
        }
        for (size_t at = 0; at < order_.size(); ++at)
            for (const uint32_t portal : portals[order_[at]])
                for (const uint32_t cell : graph.portals[portal].cells) take(cell, portal, order_[at]);
    }

    bool reached(uint32_t cell) const { return reach_[cell].reached; }
    uint64_t count() const { return order_.size(); }
    /// Cells that are reached, the nearest first.
    const std::vector<uint32_t>& order() const { return order_; }

    std::vector<glm::dvec3> wayOut(const glm::dvec3& from, uint32_t cell) const {
        std::vector<glm::dvec3> path = {from};
        for (; reach_[cell].portal != kNone; cell = reach_[cell].from) {
            const auto outline = graph_.outline(graph_.portals[reach_[cell].portal]);
            glm::dvec3 middle(0.0);
            for (const glm::dvec3& point : outline) middle += point / static_cast<double>(outline.size());
            path.push_back(middle);
        }
        path.push_back(brushes_.edge_points[reach_[cell].from]);
        return path;
    }

private:
    void take(uint32_t cell, uint32_t portal, uint32_t from) {
        if (reach_[cell].reached) return;
        reach_[cell] = {portal, from, true};
        order_.push_back(cell);
    }

    const CellGraph& graph_;
    const BrushTree& brushes_;
    std::vector<Reach> reach_;
    std::vector<uint32_t> order_;
};

}  // namespace

MapCells cellsInside(const QuakeMap& map, const BrushTree& brushes, double least_way) {
    MapCells cells;
    cells.graph = cellsOfTree(brushes.tree);
    const Flood flood(cells.graph, brushes, least_way);
    cells.outside = flood.count();
    std::vector<uint32_t> thing_in(cells.graph.cells, kNone);
    for (uint32_t i = 0; i < map.entities.size(); ++i) {
        const QuakeMapEntity& entity = map.entities[i];
        if (entity.brush_count != 0) continue;
        const auto origin = quakeOrigin(map.valueOf(entity, "origin"));
        if (!origin) continue;
        const uint32_t cell = cells.graph.cell_of_leaf[leafAt(brushes.tree, *origin)];
        if (cell == CellGraph::kNoCell) continue;
        ++cells.standing;
        cells.reached += flood.reached(cell);
        if (thing_in[cell] == kNone) thing_in[cell] = i;
    }
    if (cells.reached == 0) {
        std::vector<uint32_t> numbers(cells.graph.cells, CellGraph::kNoCell);
        for (const CellPortal& portal : cells.graph.portals)
            cells.closed += flood.reached(portal.cells[0]) != flood.reached(portal.cells[1]);
        uint32_t inside = 0;
        for (uint32_t cell = 0; cell < cells.graph.cells; ++cell)
            if (!flood.reached(cell)) numbers[cell] = inside++;
        cells.graph = mergeCells(cells.graph, numbers, inside);
        return cells;
    }
    const auto nearest = std::find_if(flood.order().begin(), flood.order().end(),
                                      [&](uint32_t cell) { return thing_in[cell] != kNone; });
    const uint32_t thing = thing_in[*nearest];
    const QuakeMapEntity& entity = map.entities[thing];
    cells.leaks.push_back({thing, std::string(map.valueOf(entity, "classname")),
                           flood.wayOut(*quakeOrigin(map.valueOf(entity, "origin")), *nearest)});
    return cells;
}

std::string pointFile(const MapLeak& leak, double step) {
    std::string text;
    const auto add = [&](const glm::dvec3& point) {
        char line[128];
        std::snprintf(line, sizeof line, "%.3f %.3f %.3f\n", point.x, 0 - point.z, point.y);
        text += line;
    };
    for (size_t i = 0; i + 1 < leak.path.size(); ++i) {
        const glm::dvec3 way = leak.path[i + 1] - leak.path[i];
        const double pieces = std::min(1e5, std::max(1.0, std::ceil(glm::length(way) / step)));
        for (double k = 0; k < pieces; ++k) add(leak.path[i] + k / pieces * way);
    }
    if (!leak.path.empty()) add(leak.path.back());
    return text;
}

}  // namespace sightline::bake
