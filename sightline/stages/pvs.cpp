// The stage of the PVS: keeps what stands in cells that rows of visibility show from the eye's cells.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
#include "sightline/base/assert.h"
#include "sightline/cells/pvs.h"

#include "sightline/stages/pipeline.h"
#include "sightline/world/seen_objects.h"

namespace sightline::detail {

void CellMemory::findRows(const Frame& frame) {
    if (!frame.world) return;
    const CellState& cells = frame.world->cell_state;
    if (pvs_of_ != cells.cells) {
        pvs_.clear();
        seen_objects_.clear();
        rows_filled_ = false;
    }
    pvs_of_ = cells.cells;  // of another world, or none: what is kept of the last one goes, whose memory may
    if (!uses(Stage::kPvs)) return;
    const auto& views = cells.cells->views;
    bool changed = cells.cells->hasRows() && pvs_.update(cells.cells->graph, cells.cells->rows, start_);
    if (views) {
        startCells(views->graph, frame.view, view_start_);
        changed = seen_objects_.update(views->graph, *views, view_start_);
    }
    if (changed) rows_filled_ = false;
    if (!(views ? seen_objects_ : pvs_).known()) stages_ &= ~stageBit(Stage::kPvs);
    else if (!rows_filled_) fillRows();
}

/// Admits all that the rows of the view cells show or, without these, what stands in cells that the rows of cells show.
void CellMemory::fillRows() {
    SIGHTLINE_DEBUG_ASSERT(now_ && uses(Stage::kPvs));
    const CellState& cells = now_.state().cell_state;
    candidates_.begin(now_.state(), layers_);
    candidates_.beginPvs();
    forEachSeenObject(cells, pvs_, seen_objects_, [&](uint32_t row) { candidates_.admitByPvs(row); });
    rows_filled_ = true;
}

void choosePvs(Frame& frame, StageMemory& memory) {
    memory.cells.begin(frame);
    memory.cells.findRows(frame);
}

}  // namespace sightline::detail
