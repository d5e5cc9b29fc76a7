// Flows light out of each cell until no box that it may reach is left.
// SPDX-License-Identifier: MIT
#include "sightline/bake/objects/box_visibility.h"

#include <algorithm>
#include <span>

#include "sightline/bake/flow/flow_pool.h"
#include "sightline/bake/flow/portal_flow.h"
#include "sightline/bake/flow/thin_cells.h"
#include "sightline/bake/flow/witness_rays.h"
#include "sightline/base/assert.h"

namespace sightline::bake {
namespace {

constexpr uint32_t kBatch = 256;  // cells between two looks at `stop`

/// The boxes of each cell.
struct BoxesOfCells {
    std::vector<uint32_t> first, inside, everywhere;

    BoxesOfCells(const CellBoxes& boxes, uint32_t cells) : first(cells + 1, 0), inside(boxes.cells.size()) {
        for (const uint32_t cell : boxes.cells) ++first[cell + 1];
        for (uint32_t c = 0; c < cells; ++c) first[c + 1] += first[c];
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (uint32_t box = 0; box < boxes.boxes.size(); ++box) {
            const uint32_t begin = boxes.first_cell[box], end = boxes.first_cell[box + 1];
            for (uint32_t i = begin; i < end; ++i) inside[next[boxes.cells[i]]++] = box;
            if (begin == end || !boxes.boxes[box].finite()) everywhere.push_back(box);
        }
    }
    template <class Visit>
    void forEach(uint32_t cell, Visit&& visit) const {
        for (uint32_t i = first[cell]; i < first[cell + 1]; ++i) visit(inside[i]);
    }
};

/// The bake, of a graph without thin cells.
BoxVisibility bakeBoxes(const CellGraph& graph, const CellVisibility& cells, const CellBoxes& boxes,
                        const CellVisibilitySettings& settings) {
    const FlowPortals directed = flowPortalsOf(graph);
    SIGHTLINE_ASSERT(cells.follows.rows() == directed.size());
    const WitnessRays rays(directed);
    const FlowPlaces places(directed);
    FlowPool pool(places, rays, cells.follows);
    const BoxesOfCells of_cells(boxes, graph.cells);
    std::vector<Box3d> shifted = boxes.boxes;
    for (Box3d& box : shifted) {
        box.min -= directed.center;
        box.max -= directed.center;
    }
    const auto count = static_cast<uint32_t>(boxes.boxes.size());
    BoxVisibility answer;
    answer.visible = BitMatrix(graph.cells, count);
    std::vector<uint64_t> by_cells(graph.cells, 0), spent(graph.cells, 0);

    StopAsker stop(settings.stop);
    const auto flow = [&](uint32_t cell) {
        // Boxes that lie only in hidden cells are not looked for.
        std::vector<uint8_t> found(count, 1);
        for (uint32_t other = 0; other < graph.cells; ++other)
            if (cells.visible.at(cell, other)) of_cells.forEach(other, [&](uint32_t box) { found[box] = 0; });
        for (const uint32_t box : of_cells.everywhere) found[box] = 0;
        std::vector<uint8_t> may(found);
        for (const uint8_t hidden : found) by_cells[cell] += !hidden;
        of_cells.forEach(cell, [&](uint32_t box) { found[box] = 1; });
        for (const uint32_t box : of_cells.everywhere) found[box] = 1;
        FlowAnswer flowed;
        const FlowBoxes looked_for{shifted, of_cells.first, of_cells.inside, found};
        for (uint32_t p = directed.first_of_cell[cell]; p < directed.first_of_cell[cell + 1]; ++p) {
            pool.find(p, looked_for, {settings.budget, 0, &stop}, flowed);
            spent[cell] += flowed.spent;
        }
        for (uint32_t box = 0; box < count; ++box)
            if (!may[box] && found[box]) answer.visible.set(cell, box);
    };
    for (uint32_t done = 0; done < graph.cells; done += kBatch) {
        const uint32_t size = std::min(kBatch, graph.cells - done);
        if (stop.asks()) {
            for (uint32_t cell = done; cell < graph.cells; ++cell)
                for (uint32_t box = 0; box < count; ++box) answer.visible.set(cell, box);
            break;
        }
        runJobs(settings.jobs, size, [&](uint32_t i) { flow(done + i); });
        if (settings.progress)
            settings.progress({"objects", static_cast<double>(done + size) / static_cast<double>(graph.cells)});
    }
    answer.stopped = stop.stopped();
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        answer.by_cells += by_cells[cell];
        answer.over_budget += spent[cell];
    }
    return answer;
}

}  // namespace

BoxVisibility bakeBoxVisibility(const CellGraph& graph, const CellVisibility& cells, const CellBoxes& boxes,
                                const CellVisibilitySettings& settings) {
    const ThinMerged thin = mergeThinCells(graph);
    if (!thin.any) return bakeBoxes(graph, cells, boxes, settings);
    CellVisibility merged;
    merged.visible = BitMatrix(thin.graph.cells, thin.graph.cells);
    merged.follows = cells.follows;
    for (uint32_t a = 0; a < graph.cells; ++a)
        for (uint32_t b = 0; b < graph.cells; ++b)
            if (cells.visible.at(a, b)) merged.visible.set(thin.cell_of_cell[a], thin.cell_of_cell[b]);
    CellBoxes moved;
    std::vector<uint32_t> in;
    for (size_t box = 0; box < boxes.boxes.size(); ++box) {
        in.clear();
        for (uint32_t i = boxes.first_cell[box]; i < boxes.first_cell[box + 1]; ++i)
            in.push_back(thin.cell_of_cell[boxes.cells[i]]);
        std::sort(in.begin(), in.end());
        in.erase(std::unique(in.begin(), in.end()), in.end());
        moved.add(boxes.boxes[box], in);
    }
    const BoxVisibility found = bakeBoxes(thin.graph, merged, moved, settings);
    BoxVisibility answer = found;
    answer.visible = BitMatrix(graph.cells, boxes.boxes.size());
    answer.by_cells = 0;
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        const uint32_t now = thin.cell_of_cell[cell];
        std::ranges::copy(found.visible.row(now), answer.visible.row(cell).begin());
        for (size_t box = 0; box < moved.boxes.size(); ++box) {
            const auto begin = moved.cells.begin() + moved.first_cell[box],
                       end = moved.cells.begin() + moved.first_cell[box + 1];
            answer.by_cells +=
                begin == end || !moved.boxes[box].finite() ||
                std::any_of(begin, end, [&](uint32_t in_cell) { return merged.visible.at(now, in_cell); });
        }
    }
    return answer;
}

}  // namespace sightline::bake
