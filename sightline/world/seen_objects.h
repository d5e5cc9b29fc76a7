// Which objects rows of visibility show: those of view cells, or what stands in the cells that rows of cells show.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "sightline/base/assert.h"
#include "sightline/cells/pvs.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// Calls visit(row) for each object in cells that the rows show, some of them more than once. Objects that are in no
/// cell are not among them: CellState::free has these.
/// @param by_cells    the rows of AttachedCells::rows
/// @param by_objects  the rows of AttachedCells::views; they decide if there are any
/// @pre the ones that decide are known
template <class Visit>
void forEachSeenObject(const CellState& cells, const PotentiallyVisible& by_cells, const PotentiallyVisible& by_objects,
                       Visit&& visit) {
    SIGHTLINE_DEBUG_ASSERT(cells.cells && (cells.cells->views ? by_objects : by_cells).known());
    const auto visitAll = [&](const CellLists& lists, uint32_t cell) {
        for (uint32_t at = lists.first[cell]; at != CellBlock::kNone;) {
            const CellBlock& block = lists.blocks[at];
            SIGHTLINE_DEBUG_ASSERT(block.used > 0 && block.used <= 8);
            for (uint32_t lane = 0; lane < block.used; ++lane) visit(block.row[lane]);
            at = block.next;
        }
    };
    if (!cells.cells->views)
        return cells.cells->forEachCell(by_cells.rows(), [&](uint32_t cell) { visitAll(cells.lists, cell); });
    const std::span<const uint64_t> seen = by_objects.rows();
    for (size_t word = 0; word < seen.size(); ++word)
        for (uint64_t bits = seen[word]; bits; bits &= bits - 1) {
            const uint32_t row = cells.claims[64 * word + static_cast<size_t>(std::countr_zero(bits))];
            if (row < CellState::kNoRow) visit(row);
        }
    visitAll(cells.strangers, 0);
}

}  // namespace sightline::detail
