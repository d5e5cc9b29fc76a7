// Finds portals that lie over one another on opposite sides of a cell, and merges that cell with its neighbour.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/thin_cells.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "sightline/bake/flow/flow_portals.h"
#include "sightline/bsp/merge_cells.h"

namespace sightline::bake {
namespace {

constexpr double kHardly = 4;  // [precisions]

double highest(const FlowPortals& directed, const FlowPortal& over, double sign, uint32_t q) {
    double high = -1e300;
    for (const glm::dvec3& point : directed.outline(q)) high = std::max(high, sign * over.height(point));
    return high;
}

/// Whether two ways out of a cell lead to opposite sides of the same plane.
bool areOnePlane(const FlowPortals& directed, uint32_t r, uint32_t q) {
    const FlowPortal &a = directed.portals[r], &b = directed.portals[q];
    if (!(glm::dot(a.normal, b.normal) < 0)) return false;
    // Of what enters through a's reverse the heights are turned round.
    return a.sheet == b.sheet || highest(directed, a, -1, q) <= a.above || highest(directed, b, -1, r) <= b.above;
}

/// Whether no edge of `a`, prolonged, has all of `b` outside, or hardly inside.
bool reachesInto(const FlowPortals& directed, uint32_t a, uint32_t b) {
    const double hardly = kHardly * std::max(directed.portals[a].precision, directed.portals[b].precision);
    const std::span<const glm::dvec3> outline = directed.outline(a);
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
        const double length = glm::length(edge);
        if (!(length > 0)) continue;
        const glm::dvec3 inward = glm::cross(directed.portals[a].normal, edge) / length;
        double most = -1e300;
        for (const glm::dvec3& point : directed.outline(b)) most = std::max(most, glm::dot(inward, point - outline[i]));
        if (most <= hardly) return false;
    }
    return true;
}

ThinMerged mergeOnce(const CellGraph& graph) {
    const FlowPortals directed = flowPortalsOf(graph);
    std::vector<uint32_t> root(graph.cells);
    std::iota(root.begin(), root.end(), 0u);
    const auto rootOf = [&](uint32_t cell) {
        while (root[cell] != cell) cell = root[cell] = root[root[cell]];
        return cell;
    };
    ThinMerged merged;
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        const uint32_t first = directed.first_of_cell[cell], end = directed.first_of_cell[cell + 1];
        for (uint32_t r = first; r < end; ++r)
            for (uint32_t q = r + 1; q < end; ++q) {
                if (!areOnePlane(directed, r, q) || !reachesInto(directed, r, q) || !reachesInto(directed, q, r))
                    continue;
                const uint32_t a = rootOf(cell), b = rootOf(directed.portals[r].to);
                root[std::max(a, b)] = std::min(a, b);
                merged.any = true;
            }
    }
    if (!merged.any) return merged;
    merged.cell_of_cell.resize(graph.cells);
    uint32_t cells = 0;
    for (uint32_t cell = 0; cell < graph.cells; ++cell)
        merged.cell_of_cell[cell] = rootOf(cell) == cell ? cells++ : merged.cell_of_cell[rootOf(cell)];
    merged.graph = mergeCells(graph, merged.cell_of_cell, cells);
    return merged;
}

}  // namespace

ThinMerged mergeThinCells(const CellGraph& graph) {
    ThinMerged merged = mergeOnce(graph);
    // A portal whose points are known badly lies over others farther off: what was merged may be thin for it again.
    while (merged.any) {
        ThinMerged again = mergeOnce(merged.graph);
        if (!again.any) break;
        for (uint32_t& cell : merged.cell_of_cell) cell = again.cell_of_cell[cell];
        merged.graph = std::move(again.graph);
    }
    return merged;
}

}  // namespace sightline::bake
