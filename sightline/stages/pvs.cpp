// The stage of the PVS: keeps what stands in cells that rows of visibility show from the eye's cells.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
#include "sightline/cells/pvs.h"

#include "sightline/stages/pipeline.h"

namespace sightline::detail {

void CellMemory::findRows(const Frame& frame) {
    if (!uses(Stage::kPvs)) return;
    const CellState& cells = frame.world->cell_state;
    if (pvs_of_ != cells.cells) pvs_.clear();
    pvs_of_ = cells.cells;
    if (pvs_.update(cells.cells->graph, cells.cells->rows, start_)) rows_filled_ = false;
    if (!pvs_.known()) stages_ &= ~stageBit(Stage::kPvs);
    else if (!rows_filled_) fillRows();
}

/// Admits all that stands in cells that the rows show.
void CellMemory::fillRows() {
    const CellState& cells = now_.state().cell_state;
    candidates_.begin(now_.state(), layers_);
    candidates_.beginPvs();
    cells.cells->forEachCell(pvs_.rows(), [&](uint32_t cell) {
        for (uint32_t at = cells.lists.first[cell]; at != CellBlock::kNone;) {
            const CellBlock& block = cells.lists.blocks[at];
            for (uint32_t lane = 0; lane < block.used; ++lane) candidates_.admitByPvs(block.row[lane]);
            at = block.next;
        }
    });
    rows_filled_ = true;
}

void choosePvs(Frame& frame, StageMemory& memory) {
    memory.cells.begin(frame);
    memory.cells.findRows(frame);
}

}  // namespace sightline::detail
