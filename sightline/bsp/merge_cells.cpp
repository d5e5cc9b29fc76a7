// Coarser graphs of cells: new numbers for old; groups by union and find.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/merge_cells.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "sightline/base/assert.h"
#include "sightline/geom/outline_hull.h"

namespace sightline {

CellGraph mergeCells(const CellGraph& graph, std::span<const uint32_t> cell_of_cell, uint32_t cells) {
    SIGHTLINE_ASSERT(cell_of_cell.size() == graph.cells);
    CellGraph merged;
    merged.cells = cells;
    for (const CellPortal& portal : graph.portals) {
        const uint32_t a = cell_of_cell[portal.cells[0]], b = cell_of_cell[portal.cells[1]];
        if (a == b || a == CellGraph::kNoCell || b == CellGraph::kNoCell) continue;
        merged.addPortal(a, b, graph.outline(portal), portal.plane);
        merged.portals.back().door = portal.door;
    }
    merged.cell_of_leaf.reserve(graph.cell_of_leaf.size());
    for (const uint32_t cell : graph.cell_of_leaf)
        merged.cell_of_leaf.push_back(cell == CellGraph::kNoCell ? cell : cell_of_cell[cell]);
    return merged;
}

CellGraph joinPortals(const CellGraph& graph) {
    // By pair and plane, seen from the lower cell; of one plane in the graph's order.
    struct Place {
        std::tuple<uint32_t, uint32_t, double, double, double, double> key;
        uint32_t portal;
        bool turned;
        bool operator<(const Place& other) const { return std::tie(key, portal) < std::tie(other.key, other.portal); }
    };
    std::vector<Place> places;
    CellGraph joined;
    joined.cells = graph.cells;
    joined.cell_of_leaf = graph.cell_of_leaf;
    for (uint32_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& portal = graph.portals[i];
        if (portal.door != CellPortal::kNone) {
            joined.addPortal(portal.cells[0], portal.cells[1], graph.outline(portal), portal.plane);
            joined.portals.back().door = portal.door;
            continue;
        }
        const bool turned = portal.cells[0] > portal.cells[1];
        // Adding zero makes one of the two zeros.
        const glm::dvec4 plane = (turned ? -portal.plane : portal.plane) + 0.0;
        places.push_back(
            {{portal.cells[turned], portal.cells[!turned], plane.x, plane.y, plane.z, plane.w}, i, turned});
    }
    std::sort(places.begin(), places.end());
    std::vector<glm::dvec3> points;
    for (size_t i = 0; i < places.size();) {
        size_t end = i + 1;
        while (end < places.size() && places[end].key == places[i].key) ++end;
        const auto& [a, b, x, y, z, w] = places[i].key;
        points.clear();
        for (size_t k = i; k < end; ++k) {
            const std::span<const glm::dvec3> outline = graph.outline(graph.portals[places[k].portal]);
            if (places[k].turned) points.insert(points.end(), outline.rbegin(), outline.rend());
            else points.insert(points.end(), outline.begin(), outline.end());
        }
        if (end > i + 1) {
            std::vector<glm::dvec3> hull = outlineHull(points, glm::dvec3(x, y, z));
            if (hull.size() >= 3) {
                joined.addPortal(a, b, hull, glm::dvec4(x, y, z, w));
                i = end;
                continue;
            }
        }
        // Alone, or all in a line: as they are.
        size_t first = 0;
        for (; i < end; ++i) {
            const size_t count = graph.portals[places[i].portal].count;
            joined.addPortal(a, b, std::span<const glm::dvec3>(points).subspan(first, count), glm::dvec4(x, y, z, w));
            first += count;
        }
    }
    return joined;
}

std::vector<uint32_t> cellsFromLeaves(const CellGraph& graph, std::span<const uint32_t> number_of_leaf) {
    SIGHTLINE_ASSERT(number_of_leaf.size() <= graph.cell_of_leaf.size());
    std::vector<uint32_t> numbers(graph.cells, CellGraph::kNoCell);
    for (size_t leaf = 0; leaf < number_of_leaf.size(); ++leaf) {
        const uint32_t cell = graph.cell_of_leaf[leaf];
        if (cell != CellGraph::kNoCell && numbers[cell] == CellGraph::kNoCell) numbers[cell] = number_of_leaf[leaf];
    }
    return numbers;
}

std::vector<uint32_t> groupsOf(const CellGraph& graph) {
    std::vector<uint32_t> root(graph.cells);
    std::iota(root.begin(), root.end(), 0u);
    const auto rootOf = [&](uint32_t cell) {
        while (root[cell] != cell) cell = root[cell] = root[root[cell]];
        return cell;
    };
    for (const CellPortal& portal : graph.portals) {
        const uint32_t a = rootOf(portal.cells[0]), b = rootOf(portal.cells[1]);
        root[a < b ? b : a] = a < b ? a : b;  // the first cell of a group is its root
    }
    std::vector<uint32_t> group(graph.cells);
    uint32_t groups = 0;
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        const uint32_t first = rootOf(cell);
        group[cell] = first == cell ? groups++ : group[first];
    }
    return group;
}

}  // namespace sightline
