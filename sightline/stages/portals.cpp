// The stage of portals: keeps what reaches into a window that portals leave of the image in a cell that it stands in.
// SPDX-License-Identifier: MIT
//
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
#include "sightline/base/assert.h"
#include "sightline/cells/portals.h"

#include <bit>
#include <cmath>
#include <limits>

#include "sightline/cull/frustum.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {
namespace {

float roundDown(double value) {
    const float rounded = static_cast<float>(value);
    return static_cast<double>(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
                                                : rounded;
}

WindowRect rectOf(const SeenCell& cell) {
    return {roundDown(cell.left), roundDown(cell.bottom), -roundDown(-cell.right), -roundDown(-cell.top)};
}

}  // namespace

void CellMemory::findWindows(const Frame& frame) {
    const bool rows = uses(Stage::kPvs);
    if (uses(Stage::kPortals)) {
        const CellState& cells = frame.world->cell_state;
        SIGHTLINE_DEBUG_ASSERT(cells.cells && cells.doors && cells.doors->size() == cells.cells->graph.doors());
        const PortalSettings settings{frame.settings.windows, frame.settings.portal_work, frame.settings.portal_depth};
        flooded_ = flood_.run(cells.cells->graph, frame.view, settings, *cells.doors,
                              rows && pvs_.known() ? pvs_.rows() : std::span<const uint64_t>());
        portal_stats_ = flood_.stats();
        if (!flooded_) giveUp(Stage::kPortals, frame);
        else if (showMost()) {
            flooded_ = false;
            stages_ &= ~stageBit(Stage::kPortals);
        }
    }
    if (!stages_) return;
    if (!rows) {
        candidates_.begin(now_.state(), layers_);
        rows_filled_ = false;
    }
    if (flooded_) {
        candidates_.beginWindows();
        fillWindows(eyePosition(frame.view));
    }
    candidates_.finish(stages_);
}

/// Whether the cells in sight hold so much that to admit it costs more than the rest would: the walk then goes from the
/// root, as if there were no portals.
bool CellMemory::showMost() const {
    constexpr uint64_t kFew = 1024;
    const CellLists& lists = now_.state().cell_state.lists;
    uint64_t stands = 0;
    for (const SeenCell& seen : flood_.cells()) {
        SIGHTLINE_DEBUG_ASSERT(seen.cell < lists.count.size());
        stands += lists.count[seen.cell];
    }
    return stands > kFew && 2 * stands > lists.stands;
}

/// Admits all that reaches into a window of a cell that it stands in.
void CellMemory::fillWindows(const glm::dvec3& eye) {
    const CellState& cells = now_.state().cell_state;
    const glm::dvec3 offset = cells.cells->origin - eye;
    for (const SeenCell& seen : flood_.cells()) {
        SIGHTLINE_DEBUG_ASSERT(seen.cell < cells.lists.first.size());
        SIGHTLINE_DEBUG_ASSERT(size_t{seen.first_plane} + seen.plane_count <= flood_.planes().size());
        const WindowRect rect = rectOf(seen);
        const std::span<const glm::dvec4> planes = flood_.planes().subspan(seen.first_plane, seen.plane_count);
        for (uint32_t at = cells.lists.first[seen.cell]; at != CellBlock::kNone;) {
            const CellBlock& block = cells.lists.blocks[at];
            SIGHTLINE_DEBUG_ASSERT(block.used > 0 && block.used <= 8);
            uint32_t inside = (1u << block.used) - 1;
            if (!planes.empty()) inside &= ~outsideAny(planes, eyeBoxes(block.min, block.max, offset));
            for (; inside; inside &= inside - 1) candidates_.admit(block.row[std::countr_zero(inside)], rect);
            at = block.next;
        }
    }
}

void choosePortals(Frame& frame, StageMemory& memory) {
    memory.cells.findWindows(frame);
    frame.narrowTo(memory.cells.candidates());
}

/// Cuts the rectangles of a node's objects to their windows; culls those of which nothing is left.
uint32_t cutToWindows(const Frame& frame, TraversalState&, Group& group, uint32_t live) {
    uint32_t gone = 0;
    for (uint32_t bits = live & ~(group.on_screen.doubt | group.on_screen.outside); bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        if (!(group.node.child[slot] & BvhNode::kLeaf)) continue;
        PixelRect& rect = group.on_screen.rects[slot];
        rect = frame.inWindow(group.node.first[slot], rect);
        if (rect.x0 > rect.x1 || rect.y0 > rect.y1) gone |= 1u << slot;
    }
    return gone;
}

}  // namespace sightline::detail
