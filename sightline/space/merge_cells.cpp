// Coarser graphs of cells: new numbers for old; groups by union and find.
// SPDX-License-Identifier: MIT
#include "sightline/space/merge_cells.h"

#include <numeric>

#include "sightline/base/assert.h"

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
