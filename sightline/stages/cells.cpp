// What the stages of cells keep from view to view: where the eye is, the rows and windows seen from there, and the candidates.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/stages/stage_memory.h"

namespace sightline::detail {

void CellMemory::begin(const Frame& frame) {
    for (const int stage : {0, 1}) doubt_[stage] = 0;
    start_.clear();
    view_start_.clear();
    stages_ = 0;
    flooded_ = false;
    portal_stats_ = {};
    const bool same =
        frame.snapshot && now_ && &frame.snapshot.state() == &now_.state() && layers_ == frame.view.layers;
    rows_filled_ &= same;
    now_ = frame.snapshot;
    layers_ = frame.view.layers;
    // Cells of a world that is not asked any more are not held.
    if (pvs_of_ && (!now_ || now_.state().cell_state.cells != pvs_of_)) pvs_of_ = nullptr;
    if (!now_ || !frame.usable || !now_.state().cell_state.cells) return;
    const CellState& cells = now_.state().cell_state;
    stages_ = frame.stages & kCellStages;
    if (!cells.cells->hasRows() && !cells.cells->views) stages_ &= ~stageBit(Stage::kPvs);
    if (cells.cells->graph.cells() == 1) stages_ &= ~stageBit(Stage::kPortals);  // there is no other cell to cull
    if (!stages_) return;
    // A bake holds only while its walls stand where they stood, and are drawn.
    const bool stands = cells.walls_stand && (!cells.has_walls || frame.every_layer);
    if (stands && startCells(cells.cells->graph, frame.view, start_)) return;
    start_.clear();
    giveUp(Stage::kPortals, frame);
    // View cells fill all of space.
    if (!stands || !cells.cells->views) giveUp(Stage::kPvs, frame);
}

/// Keeps everything, and counts it as doubt.
void CellMemory::giveUp(Stage stage, const Frame& frame) {
    SIGHTLINE_DEBUG_ASSERT(stage == Stage::kPvs || stage == Stage::kPortals);
    if (!uses(stage)) return;
    SIGHTLINE_DEBUG_ASSERT(frame.world && frame.world == &now_.state());
    const SnapshotState& state = *frame.world;
    uint64_t objects = state.count - state.unbounded.size();
    if (!(state.common_layers & frame.view.layers)) {
        objects = 0;
        for (uint32_t place = 0; place < state.placed.size(); ++place) objects += frame.isInLayers(place);
    }
    doubt_[static_cast<int>(stage)] = objects;
    stages_ &= ~stageBit(stage);
}

}  // namespace sightline::detail
