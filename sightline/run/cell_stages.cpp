// The stages of a query that go by cells: asked once per view, before the walks.
// SPDX-License-Identifier: MIT
#include "sightline/run/cell_stages.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "sightline/cull/frustum.h"
#include "sightline/geom/depth_order.h"

namespace sightline::detail {
namespace {

using Clock = std::chrono::steady_clock;

uint64_t since(Clock::time_point start) {
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
}

float roundDown(double value) {
    const float rounded = static_cast<float>(value);
    return static_cast<double>(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
                                                : rounded;
}

WindowRect rectOf(const SeenCell& cell) {
    return {roundDown(cell.left), roundDown(cell.bottom), -roundDown(-cell.right), -roundDown(-cell.top)};
}

uint64_t objectsInLayers(const SnapshotState& state, uint32_t layers) {
    if (state.common_layers & layers) return state.count - state.unbounded.size();
    uint64_t count = 0;
    for (uint32_t place = 0; place < state.placed.size(); ++place) count += (state.placed[place].layers & layers) != 0;
    return count;
}

}  // namespace

CellStages::CellStages(Memory* memory) : start_(memory), pvs_(memory), flood_(memory), admission_(memory) {}

const Admission* CellStages::run(const Snapshot& now, const View& view) {
    for (const int stage : {0, 1}) doubt_[stage] = nanoseconds_[stage] = 0;
    start_.clear();
    flooded_ = false;
    portal_stats_ = {};
    const bool same = now && now_ && &now.state() == &now_.state() && layers_ == view.layers;
    pvs_filled_ &= same;
    now_ = now;
    layers_ = view.layers;
    if (!now || !now.state().cell_state.cells || !isUsable(view) || !runsOutward(view)) return nullptr;
    return decide(view);
}

const Admission* CellStages::decide(const View& view) {
    const SnapshotState& state = now_.state();
    const AttachedCells& cells = *state.cell_state.cells;
    uint32_t stages = stagesInUse(view) & kCellStages;
    if (!cells.hasRows()) stages &= ~stageBit(Stage::kPvs);
    if (!stages) return nullptr;
    auto start = Clock::now();
    const auto lap = [&](Stage stage) {
        nanoseconds_[static_cast<int>(stage)] += since(start);
        start = Clock::now();
    };
    const auto giveUp = [&](Stage stage) {
        if (!(stages & stageBit(stage))) return;
        doubt_[static_cast<int>(stage)] = objectsInLayers(state, view.layers);
        stages &= ~stageBit(stage);
    };
    // What was baked rests on walls that stand, and are drawn.
    const bool drawn = !state.cell_state.has_walls || (state.common_layers & view.layers) != 0 || state.count == 0;
    if (!state.cell_state.walls_stand || !drawn || !startCells(cells.graph, view, start_)) {
        start_.clear();
        giveUp(Stage::kPvs);
        giveUp(Stage::kPortals);
        return nullptr;
    }
    if (stages & stageBit(Stage::kPvs)) {
        if (pvs_of_ != state.cell_state.cells) pvs_.clear();
        pvs_of_ = state.cell_state.cells;
        if (pvs_.update(cells.graph, cells.rows, start_)) pvs_filled_ = false;
        if (!pvs_.known()) stages &= ~stageBit(Stage::kPvs);
        lap(Stage::kPvs);
    }
    const bool rows = stages & stageBit(Stage::kPvs);
    if (stages & stageBit(Stage::kPortals)) {
        const PortalSettings settings{view.windows, view.portal_work, view.portal_depth};
        flooded_ = flood_.run(cells.graph, view, settings, *state.cell_state.doors,
                              rows ? pvs_.rows() : std::span<const uint64_t>());
        portal_stats_ = flood_.stats();
        if (!flooded_) giveUp(Stage::kPortals);
        lap(Stage::kPortals);
    }
    if (!stages) return nullptr;
    if (!rows || !pvs_filled_) {
        admission_.begin(state, view.layers);
        if (rows) fillPvs();
        pvs_filled_ = rows;
        lap(rows ? Stage::kPvs : Stage::kPortals);
    }
    if (flooded_) {
        admission_.beginWindows();
        fillWindows(eyePosition(view));
        lap(Stage::kPortals);
    }
    admission_.finish(stages);
    return &admission_;
}

/// Admits all that stands in cells that the rows show.
void CellStages::fillPvs() {
    const CellState& state = now_.state().cell_state;
    admission_.beginPvs();
    state.cells->forEachCell(pvs_.rows(), [&](uint32_t cell) {
        for (uint32_t at = state.lists.first[cell]; at != CellBlock::kNone;) {
            const CellBlock& block = state.lists.blocks[at];
            for (uint32_t lane = 0; lane < block.used; ++lane) admission_.admitByPvs(block.row[lane]);
            at = block.next;
        }
    });
}

/// Admits all that reaches into a window of a cell that it stands in.
void CellStages::fillWindows(const glm::dvec3& eye) {
    const CellState& state = now_.state().cell_state;
    const glm::dvec3 offset = state.cells->origin - eye;
    for (const SeenCell& seen : flood_.cells()) {
        const WindowRect rect = rectOf(seen);
        const std::span<const glm::dvec4> planes = flood_.planes().subspan(seen.first_plane, seen.plane_count);
        for (uint32_t at = state.lists.first[seen.cell]; at != CellBlock::kNone;) {
            const CellBlock& block = state.lists.blocks[at];
            uint32_t inside = (1u << block.used) - 1;
            if (!planes.empty()) inside &= ~outsideAny(planes, eyeBoxes(block.min, block.max, offset));
            for (; inside; inside &= inside - 1) admission_.admit(block.row[std::countr_zero(inside)], rect);
            at = block.next;
        }
    }
}

}  // namespace sightline::detail
