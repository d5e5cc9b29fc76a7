// The steps from marked cells to checked ones, in their order.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/scene_cells.h"

#include "sightline/bake/marked/checked_cells.h"

namespace sightline::bake {
using namespace tools;

std::vector<uint32_t> seeAllFromOutside(CellSpace& space, BitMatrix& visible) {
    std::vector<uint32_t> out;
    if (space.outside == CellGraph::kNoCell || space.row_of_cell.empty()) return out;
    const uint32_t outside = space.row_of_cell[space.outside];
    if (outside == CellGraph::kNoCell) return out;
    space.row_of_cell[space.outside] = CellGraph::kNoCell;
    for (uint32_t row = 0; row < visible.rows(); ++row)
        if (visible.at(row, outside)) out.push_back(row);
    for (const uint32_t row : out)
        for (size_t other = 0; other < visible.rows(); ++other) {
            visible.set(row, other);
            visible.set(other, row);
        }
    return out;
}

SceneCells cellsOfScene(const Scene& scene, const SceneCellSettings& settings) {
    CheckedCells cells(scene, settings);
    cells.takeCells();
    cells.findOverlaps();
    if (settings.trusted) {
        cells.trustPortals();
    } else {
        cells.moveFaces();
        cells.placePortals();
        cells.findHoles();
    }
    return cells.finish();
}

}  // namespace sightline::bake
